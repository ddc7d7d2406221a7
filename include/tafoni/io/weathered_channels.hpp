/// \file
/// The numbers of a weathered surface as channels that the writers of PLY and VTP store.
#ifndef TAFONI_IO_WEATHERED_CHANNELS_HPP
#define TAFONI_IO_WEATHERED_CHANNELS_HPP

#include <tafoni/io/mesh_file.hpp>
#include <tafoni/weathering/weathered_surface.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace tafoni {

/// Face channels of `s.surface.mesh`: life, hold (float32, in [0, 1]), exposure, fresh (uint8, 0 or 1) and
/// shard (uint32, the index of the cell): `write_vtp("rock.vtp", s.surface.mesh, channels_of(s))`. O(triangles).
[[nodiscard]] inline mesh_attributes channels_of(weathered_surface const& s) {
    mesh_attributes out;
    auto const add = [&out](char const* name, auto const& numbers, channel_type type) {
        mesh_channel channel{.name = name, .type = type};
        channel.values.assign(numbers.begin(), numbers.end());
        out.face_channels.push_back(std::move(channel));
    };
    std::vector<double> shard;
    shard.reserve(s.surface.cell.size());
    for (cell_index const c : s.surface.cell) shard.push_back(c.value);
    add("life", s.life, channel_type::float32);
    add("hold", s.hold, channel_type::float32);
    add("exposure", s.exposed, channel_type::uint8);
    add("shard", shard, channel_type::uint32);
    add("fresh", s.surface.fresh, channel_type::uint8);
    return out;
}

}  // namespace tafoni

#endif
