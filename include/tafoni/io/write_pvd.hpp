/// \file
/// Writes a .pvd: which .vtp belongs to which time. Written last, so that it never names a file that is not there.
#ifndef TAFONI_IO_WRITE_PVD_HPP
#define TAFONI_IO_WRITE_PVD_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/io/detail/format_number.hpp>
#include <tafoni/io/detail/write_file.hpp>
#include <tafoni/io/detail/xml.hpp>

#include <cmath>
#include <filesystem>
#include <span>
#include <string>

namespace tafoni {

/// One file of a time series.
struct pvd_entry {
    double time = 0;           ///< any unit, finite
    std::string file{};        ///< path relative to the .pvd
    std::uint32_t part = 0;    ///< tells files of the same time apart
};

/// The series as the bytes of a .pvd. O(entries).
/// \throws invalid_input  `bad_parameter` for a time that is not finite.
[[nodiscard]] inline std::string encode_pvd(std::span<pvd_entry const> entries) {
    std::string out =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
    for (pvd_entry const& e : entries) {
        if (!std::isfinite(e.time)) {
            detail::fail<invalid_input>(errc::bad_parameter, "write_pvd: the time of " + e.file + " is not finite",
                                        {.kind = entity::parameter, .value = e.time});
        }
        out += "<DataSet timestep=\"";
        detail::append_number(out, e.time);
        out += "\" part=\"" + std::to_string(e.part) + "\" file=\"" + detail::xml_escaped(e.file) + "\"/>\n";
    }
    return out + "</Collection>\n</VTKFile>\n";
}

/// Writes a .pvd file, atomically. \throws invalid_input  as above. \throws io_error  `write_failed`, `not_a_file`.
inline void write_pvd(std::filesystem::path const& path, std::span<pvd_entry const> entries) {
    detail::write_file("write_pvd", path, encode_pvd(entries));
}

}  // namespace tafoni

#endif
