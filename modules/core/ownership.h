// Tells who owns files and folders, and who else can change them.
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <unistd.h>

namespace patina {

// True for a link that the kernel would not follow for `user` (fs.protected_symlinks), whether or
// not it does here: it lies in a sticky folder that everyone may write into, such as /tmp, and
// belongs neither to the user nor to that folder's owner.
bool isForeignLink(const std::filesystem::path& path, uid_t user = ::geteuid());

// Throws FileError if `link`, met on the way to the output `path`, is foreign in this sense.
void refuseForeignLink(const std::filesystem::path& link, const std::filesystem::path& path);

// True for a folder, not a link to one, that belongs to `user`.
bool isOwnFolder(const std::filesystem::path& path, uid_t user = ::geteuid());
// The same with mode 0700, so that nobody else can read it or write into it.
bool isPrivateFolder(const std::filesystem::path& path, uid_t user = ::geteuid());

// Folder for sockets and the like: $XDG_RUNTIME_DIR if it is private, else patina-runtime-UID in
// the folder for temporary files, which is made, if that is private.
struct RuntimeFolder {
  std::filesystem::path path; // empty: there is none
  std::string problem;        // one line about a folder that is not private
};
RuntimeFolder runtimeFolder();

// The path, free of links, of a file with code that `user` may run: only the user and root can
// change it. The file, its folder and all folders above must belong to the user or root, and none
// may be writable by others. A sticky folder is accepted above the file's folder, but not for root,
// who runs code of system folders only. A group counts as others unless it has the user's own
// number. Throws FileError with the cause and the remedy.
std::filesystem::path trustedFile(const std::filesystem::path& file, uid_t user = ::geteuid());

} // namespace patina
