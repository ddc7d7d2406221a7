#include "surface.hpp"

namespace weather {

using namespace tafoni;

void append_surface(surface_mesh& out, shard_surface const& part, link_graph const& links,
                    surface_colours const& colours, std::size_t block) {
    auto& channels = out.attributes.face_channels;
    if (channels.empty()) {
        channels = {{.name = "life", .type = channel_type::float32},
                    {.name = "hold", .type = channel_type::float32},
                    {.name = "exposure", .type = channel_type::uint8},
                    {.name = "shard", .type = channel_type::int32},
                    {.name = "fresh", .type = channel_type::uint8},
                    {.name = "block", .type = channel_type::int32}};
    }
    auto const base = static_cast<std::uint32_t>(out.mesh.vertex_count());
    for (vec3 const& p : part.mesh.positions) out.mesh.add_vertex(p);
    for (std::size_t t = 0; t < part.mesh.face_count(); ++t) {
        auto const corners = part.mesh.face(t);
        out.mesh.add_face({base + corners[0], base + corners[1], base + corners[2]});
        link_index const link = links.link_of(part.face[t]);
        bool const fresh = part.fresh[t] != 0;
        channels[0].values.push_back(fresh && link.valid() ? colours.life(link) : colours.cell_life[part.cell[t].value]);
        channels[1].values.push_back(colours.cell_life[part.cell[t].value]);
        channels[2].values.push_back(link.valid() && colours.exposed(link) ? 1 : 0);
        channels[3].values.push_back(part.cell[t].value);
        channels[4].values.push_back(fresh ? 1 : 0);
        channels[5].values.push_back(static_cast<double>(block));
    }
}

}  // namespace weather
