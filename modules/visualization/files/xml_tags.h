// Reads the tags of an XML file within bounds, before a parser that nests its calls with the
// elements and keeps all of them in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace patina {

// Calls visit for each start tag, without its angle brackets, with the offset of what follows it in
// the file and the number of elements that it stands in. <AppendedData> is the last one, since its
// bytes are not XML. Reads the file in parts. Throws FileError if elements are nested deeper than
// 32 levels or remain open at the end, for more than 10000 elements, a tag of more than 8 kB, more
// than 4 MB of tags and comments, and for a document type, CDATA, '>' in an attribute of a tag
// before data, or <AppendedData in a comment.
using VisitTag = std::function<void(std::string_view tag, std::uint64_t after, int depth)>;
void forEachTag(const std::filesystem::path& path, const VisitTag& visit);

// Returns the value of an attribute of a tag; empty if there is none.
std::string_view attributeOf(std::string_view tag, std::string_view name);

} // namespace patina
