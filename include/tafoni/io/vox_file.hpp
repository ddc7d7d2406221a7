/// \file
/// What a MagicaVoxel file holds.
#ifndef TAFONI_IO_VOX_FILE_HPP
#define TAFONI_IO_VOX_FILE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni {

/// A voxel that is not empty.
struct vox_voxel {
    std::uint8_t x = 0;
    std::uint8_t y = 0;
    std::uint8_t z = 0;       ///< up
    std::uint8_t colour = 1;  ///< index into the palette, 0 for empty

    friend bool operator==(vox_voxel const&, vox_voxel const&) = default;
};

/// A box of voxels; whatever `voxels` does not name is empty.
struct vox_model {
    std::array<std::size_t, 3> size{1, 1, 1};  ///< voxels along x, y, z; 1 .. 256
    std::vector<vox_voxel> voxels{};           ///< in the order of the file; of two at one place the later holds

    friend bool operator==(vox_model const&, vox_model const&) = default;
};

/// The models of a file, each in its own coordinates.
struct vox_file {
    std::uint32_t version = 150;
    std::vector<vox_model> models{};

    friend bool operator==(vox_file const&, vox_file const&) = default;
};

}  // namespace tafoni

#endif
