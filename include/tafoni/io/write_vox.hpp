/// \file
/// Writes MagicaVoxel files (.vox).
#ifndef TAFONI_IO_WRITE_VOX_HPP
#define TAFONI_IO_WRITE_VOX_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/io/detail/format_number.hpp>
#include <tafoni/io/detail/write_file.hpp>
#include <tafoni/io/vox_file.hpp>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace tafoni {

/// The models as the bytes of a file of that version. `read_vox` gives them back. O(voxels).
/// \throws invalid_input  `bad_count` for a size beyond 1 .. 256, `out_of_range` for a voxel outside its model,
///                        `unsupported` for a version other than 150 and 200, `empty_input` without a model.
/// \throws io_error       `format_limit` for more than 4 GB.
[[nodiscard]] inline std::string encode_vox(vox_file const& file) {
    if (file.version != 150 && file.version != 200) {
        detail::fail<invalid_input>(errc::unsupported, "write_vox: version " + std::to_string(file.version));
    }
    if (file.models.empty()) detail::fail<invalid_input>(errc::empty_input, "write_vox: there is no model");
    std::string chunks;
    auto const open = [&chunks](char const* id, std::uint64_t content) {
        chunks += id;
        detail::append_little(chunks, static_cast<std::uint32_t>(content));
        detail::append_little(chunks, std::uint32_t{0});
    };
    for (std::size_t m = 0; m < file.models.size(); ++m) {
        vox_model const& model = file.models[m];
        open("SIZE", 12);
        for (std::size_t const n : model.size) {
            if (n == 0 || n > 256) {
                detail::fail<invalid_input>(errc::bad_count, "write_vox: model " + std::to_string(m) + " has a size of " +
                                                                 std::to_string(n) + ", allowed [1, 256]");
            }
            detail::append_little(chunks, static_cast<std::uint32_t>(n));
        }
        if (model.voxels.size() > std::numeric_limits<std::uint32_t>::max() / 8 || chunks.size() > 0xf0000000U) {
            detail::fail<io_error>(errc::format_limit, "write_vox: more voxels than the format can count");
        }
        open("XYZI", 4 + 4 * model.voxels.size());
        detail::append_little(chunks, static_cast<std::uint32_t>(model.voxels.size()));
        for (std::size_t v = 0; v < model.voxels.size(); ++v) {
            vox_voxel const& at = model.voxels[v];
            if (at.x >= model.size[0] || at.y >= model.size[1] || at.z >= model.size[2]) {
                detail::fail<invalid_input>(errc::out_of_range, "write_vox: voxel " + std::to_string(v) + " of model " +
                                                                    std::to_string(m) + " lies outside it",
                                            {.kind = entity::voxel, .index = v});
            }
            for (std::uint8_t const byte : {at.x, at.y, at.z, at.colour}) chunks += static_cast<char>(byte);
        }
    }
    if (chunks.size() > std::numeric_limits<std::uint32_t>::max()) {
        detail::fail<io_error>(errc::format_limit, "write_vox: more than 4 GB");
    }
    std::string out = "VOX ";
    detail::append_little(out, file.version);
    out += "MAIN";
    detail::append_little(out, std::uint32_t{0});
    detail::append_little(out, static_cast<std::uint32_t>(chunks.size()));
    return out += chunks;
}

/// Writes a MagicaVoxel file. \throws as `encode_vox`, and io_error `write_failed`, `not_a_file`.
inline void write_vox(std::filesystem::path const& path, vox_file const& file) {
    detail::write_file("write_vox", path, encode_vox(file));
}

}  // namespace tafoni

#endif
