/// \file
/// Text inside an XML attribute.
#ifndef TAFONI_IO_DETAIL_XML_HPP
#define TAFONI_IO_DETAIL_XML_HPP

#include <string>
#include <string_view>

namespace tafoni::detail {

[[nodiscard]] inline std::string xml_escaped(std::string_view text) {
    std::string out;
    for (char const c : text) {
        switch (c) {
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            default: out += c;
        }
    }
    return out;
}

}  // namespace tafoni::detail

#endif
