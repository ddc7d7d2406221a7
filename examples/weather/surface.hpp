// The skin of what stands, and of what fell, as meshes with attributes.
#pragma once

#include <tafoni/decomposition/shard_surface.hpp>
#include <tafoni/graph/link_graph.hpp>
#include <tafoni/io/mesh_file.hpp>

#include <functional>
#include <vector>

namespace weather {

struct surface_mesh {
    tafoni::indexed_mesh mesh;
    tafoni::mesh_attributes attributes;  ///< face channels: life, hold, exposure, shard, fresh, block
};

/// Numbers shown on the faces.
struct surface_colours {
    std::function<double(tafoni::link_index)> life;     ///< of a link that was laid open
    std::function<bool(tafoni::link_index)> exposed;    ///< the outside reaches it
    std::vector<double> cell_life;  ///< per cell: mean life of its links by area: how firmly it hangs; also the life of original skin
};

/// Appends `part` with its numbers; `block` tells fallen blocks apart.
void append_surface(surface_mesh& out, tafoni::shard_surface const& part, tafoni::link_graph const& links,
                    surface_colours const& colours, std::size_t block);

}  // namespace weather
