/// \file
/// Mends a mesh on request and makes a solid of it.
#ifndef TAFONI_GEOMETRY_REPAIR_SOLID_HPP
#define TAFONI_GEOMETRY_REPAIR_SOLID_HPP

#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/geometry/repair_mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// A solid made of a mended mesh.
struct repaired_solid {
    /// `polygon_of` names faces of the input; filled holes follow after its last face.
    solid body{};
    repair_report report{};
};

/// `repair_mesh`, then `make_solid`. \throws what either throws. O(n log n).
template <polygon_mesh M>
[[nodiscard]] repaired_solid repair_solid(M const& mesh, repair_options const& options,
                                          make_solid_options const& solid_options = {}) {
    std::size_t const faces = mesh_access<M>::face_count(mesh);
    if (!solid_options.artificial.empty() && solid_options.artificial.size() != faces) {
        detail::fail<invalid_input>(errc::attribute_length,
                                    "repair_solid: artificial has " +
                                        std::to_string(solid_options.artificial.size()) + " entries for " +
                                        std::to_string(faces) + " faces",
                                    {.kind = entity::attribute,
                                     .value = static_cast<double>(solid_options.artificial.size()),
                                     .limit = static_cast<double>(faces)});
    }
    repaired_mesh mended = repair_mesh(mesh, options);
    repaired_solid r{.body = make_solid(mended.mesh), .report = std::move(mended.report)};
    std::size_t filled = 0;
    std::vector<std::uint32_t> name(mended.face_of);
    for (std::uint32_t& f : name) {
        if (f == repaired_mesh::none) f = static_cast<std::uint32_t>(faces + filled++);
    }
    for (std::uint32_t& p : r.body.polygon_of) p = name[p];
    r.body.polygon_count = faces + filled;
    r.body.artificial.assign(faces + filled, 0);
    std::copy(solid_options.artificial.begin(), solid_options.artificial.end(), r.body.artificial.begin());
    return r;
}

}  // namespace tafoni

#endif
