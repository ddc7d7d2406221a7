/// \file
/// Reads a mesh of any format that the library knows, told by content first, then by extension.
#ifndef TAFONI_IO_READ_MESH_HPP
#define TAFONI_IO_READ_MESH_HPP

#include <tafoni/io/read_obj.hpp>
#include <tafoni/io/read_ply.hpp>
#include <tafoni/io/read_stl.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace tafoni {

/// Reads OBJ, PLY or STL from memory. A PLY is told by its first line and a binary STL by its size,
/// whatever the name says; else the extension of `name` decides, in any case. O(bytes).
/// \throws io_error  as the reader of the format; `wrong_format` where neither tells one.
[[nodiscard]] inline mesh_file read_mesh(std::string_view bytes, std::string_view name) {
    if (bytes.substr(0, 4) == "ply\n" || bytes.substr(0, 4) == "ply\r") return read_ply(bytes, name);
    std::size_t const dot = name.rfind('.');
    std::string extension(dot == std::string_view::npos ? std::string_view{} : name.substr(dot + 1));
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
    }
    if (extension == "stl" || (extension != "obj" && detail::is_binary_stl(bytes))) return read_stl(bytes, name);
    if (extension == "obj") return read_obj(bytes, name);
    if (extension == "ply") return read_ply(bytes, name);
    detail::source_text const source{"read_mesh", bytes, name};
    source.require_plain();
    source.fail_at_byte(source.begin(), errc::wrong_format,
                        extension == "asc" ? "an elevation grid is not a mesh; use read_esri_ascii"
                                           : "expected an .obj, .ply or .stl file");
}

/// Reads a mesh file. \throws io_error  as above, and `cannot_open`, `not_a_file`.
[[nodiscard]] inline mesh_file read_mesh(std::filesystem::path const& path) {
    detail::loaded_file const file = detail::load_file("read_mesh", path);
    return read_mesh(file.bytes(), path.string());
}

}  // namespace tafoni

#endif
