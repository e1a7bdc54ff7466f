#include "core/sha256.h"

#include <array>
#include <memory>
#include <openssl/evp.h>
#include <vector>

#include "core/descriptor.h"
#include "core/error.h"

namespace patina {

namespace {

using Digest = std::array<unsigned char, EVP_MAX_MD_SIZE>;

void require(int success, const std::string& hash = "SHA-256") {
  if (success != 1) throw Error(hash + " is not available in this system's OpenSSL");
}

std::string hexadecimal(const Digest& digest, unsigned int length) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < length; ++i) {
    text += kDigits[digest[i] >> 4];
    text += kDigits[digest[i] & 15];
  }
  return text;
}

} // namespace

std::string sha256(std::string_view bytes) {
  Digest digest{};
  unsigned int length = 0;
  require(EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr));
  return hexadecimal(digest, length);
}

std::string md5(std::string_view bytes) {
  Digest digest{};
  unsigned int length = 0;
  require(EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_md5(), nullptr),
          "MD5");
  return hexadecimal(digest, length);
}

std::string sha256OfFile(const std::filesystem::path& path) {
  const Descriptor file(openToRead(path));
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> hash(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  require(EVP_DigestInit_ex(hash.get(), EVP_sha256(), nullptr));
  std::vector<char> part(std::size_t{1} << 20);
  while (const std::size_t size = readSome(file.get(), path.string(), part.data(), part.size()))
    require(EVP_DigestUpdate(hash.get(), part.data(), size));
  Digest digest{};
  unsigned int length = 0;
  require(EVP_DigestFinal_ex(hash.get(), digest.data(), &length));
  return hexadecimal(digest, length);
}

} // namespace patina
