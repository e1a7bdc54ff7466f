#include "session/store/growing_file.h"

#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <utility>

#include "core/disk_error.h"
#include "core/file.h"
#include "core/output_target.h"

namespace patina {
namespace {

constexpr std::chrono::milliseconds kInterval{500};

} // namespace

GrowingFile::GrowingFile(const std::filesystem::path& path, std::string_view first)
    : name_(path.string()) {
  const OutputTarget target = outputTarget(path);
  if (target.is_stream) {
    stream_.reset(target.descriptor >= 0 ? ::fcntl(target.descriptor, F_DUPFD_CLOEXEC, 3)
                                         : openStream(target.path));
    if (stream_.get() < 0) throw DiskError(name_, "cannot be written: " + reason(errno));
    write(first);
  } else {
    if (target.exists) AppendFile{target.path}; // throws if another program writes it
    writeFileAtomically(target.path, first);
    file_ = std::make_unique<AppendFile>(target.path);
  }
  waiting_.reserve(kMostWaiting);
  writing_.reserve(kMostWaiting);
  thread_ = std::thread([this] { run(); });
}

GrowingFile::~GrowingFile() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wakes_.notify_one();
  thread_.join();
}

bool GrowingFile::append(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (broken_ || waiting_.size() + bytes.size() > kMostWaiting) return false;
  waiting_ += bytes;
  added_ += bytes.size();
  if (waiting_.size() > kMostWaiting / 2) wakes_.notify_one();
  return true;
}

void GrowingFile::flush() {
  std::unique_lock lock(mutex_);
  const std::uint64_t failures = failures_, all = added_;
  asked_ = true;
  wakes_.notify_one();
  done_.wait(lock, [&] { return written_ >= all || broken_ || failures_ > failures; });
  if (written_ < all) std::rethrow_exception(problem_);
}

std::string GrowingFile::problem() const {
  const std::lock_guard lock(mutex_);
  if (!problem_) return {};
  try {
    std::rethrow_exception(problem_);
  } catch (const std::exception& error) {
    return error.what();
  }
}

void GrowingFile::write(std::string_view bytes) {
  if (file_)
    file_->append(bytes);
  else if (!writeAll(stream_.get(), bytes))
    throw DiskError(name_, "cannot be written: " + reason(errno));
}

void GrowingFile::run() {
  std::unique_lock lock(mutex_);
  for (bool last = false; !last;) {
    wakes_.wait_for(lock, kInterval, [this] {
      return stopping_ || asked_ || (!problem_ && waiting_.size() > kMostWaiting / 2);
    });
    last = stopping_;
    asked_ = false;
    while (!broken_ && !(writing_.empty() && waiting_.empty())) {
      if (writing_.empty()) std::swap(writing_, waiting_);
      lock.unlock();
      std::exception_ptr problem;
      try {
        write(writing_);
      } catch (const std::exception&) {
        problem = std::current_exception();
      }
      lock.lock();
      problem_ = problem;
      if (problem) {
        ++failures_;
        broken_ = !file_; // part of the bytes may have gone
        break;
      }
      written_ += writing_.size();
      writing_.clear();
    }
    done_.notify_all();
  }
}

} // namespace patina
