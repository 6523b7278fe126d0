// URIs as glTF files have them: paths, and data that they hold themselves.
#pragma once

#include <string>
#include <string_view>

namespace whit {

// RFC 3986, section 2.1.
std::string percentDecoded(std::string_view uri);
bool isDataUri(const std::string& uri);
// Decodes a data URI of any type (RFC 2397; base64: RFC 4648, padded or not). Throws badScene at
// `where`.
std::string dataOfUri(const std::string& uri, const std::string& where);

}  // namespace whit
