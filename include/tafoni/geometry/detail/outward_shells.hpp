/// \file
/// Finds the shells of a mesh that face inwards although they lie in no other one.
#ifndef TAFONI_GEOMETRY_DETAIL_OUTWARD_SHELLS_HPP
#define TAFONI_GEOMETRY_DETAIL_OUTWARD_SHELLS_HPP

#include <tafoni/geometry/detail/edge_table.hpp>
#include <tafoni/geometry/detail/shell_nesting.hpp>
#include <tafoni/geometry/triangulate.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// The faces of each shell that has to be turned: of negative volume and in no other, or inside such a
/// one. `across` pairs sides, the largest number for none. O(triangles); where a shell faces inwards also O(shells + triangles
/// of the shells whose boxes hold it) per shell.
[[nodiscard]] inline std::vector<std::vector<std::uint32_t>> inward_shells(indexed_mesh const& mesh,
                                                                          std::vector<std::uint32_t> const& across) {
    constexpr std::uint32_t none = face_index::none;
    disjoint_sets sets(mesh.face_count());
    {
        edge_table const edges(mesh);
        for (std::size_t c = 0; c < across.size(); ++c) {
            if (across[c] != none) sets.join(edges.face_of(c), edges.face_of(across[c]));
        }
    }
    struct shell {
        std::vector<std::uint32_t> faces{};
        std::vector<std::array<vec3, 3>> triangles{};
        double six_volume = 0;
        double six_size = 0;
        box3 bounds{};
        vec3 lowest{0, 0, 0};
    };
    box3 all;
    for (std::uint32_t const v : mesh.corners) all.include(mesh.positions[v]);
    vec3 const extent = all.extent();
    int const exponent = std::ilogb(std::max(extent[0], std::max(extent[1], extent[2])));
    if (mesh.corners.empty() || exponent > 1000 || exponent < -1000) return {};
    std::vector<shell> shells;
    std::vector<std::uint32_t> shell_at(mesh.face_count(), none);
    std::vector<std::array<std::uint32_t, 3>> cut;
    std::vector<vec3> places;
    ear_clipper clip;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        std::uint32_t const root = sets.root(f);
        if (root == f) {
            shell_at[f] = static_cast<std::uint32_t>(shells.size());
            shells.emplace_back().lowest = mesh.positions[mesh.face(f)[0]];
        }
        shell& sh = shells[shell_at[root]];
        sh.faces.push_back(f);
        cut.clear();
        places.clear();
        for (std::uint32_t const v : mesh.face(f)) {
            vec3 const& p = mesh.positions[v];
            places.push_back(p);
            sh.bounds.include(p);
            if (lexicographically_less(p, sh.lowest)) sh.lowest = p;
        }
        clip(places, cut);
        for (auto const& t : cut) {
            std::array<vec3, 3> const tri{places[t[0]], places[t[1]], places[t[2]]};
            sh.triangles.push_back(tri);
            auto const local = [&](vec3 const& p) {
                return vec3{std::ldexp(p[0] - all.lo[0], -exponent), std::ldexp(p[1] - all.lo[1], -exponent),
                            std::ldexp(p[2] - all.lo[2], -exponent)};
            };
            volume_term const term = make_volume_term(local(tri[0]), local(tri[1]), local(tri[2]));
            sh.six_volume += term.six_volume;
            sh.six_size += term.size;
        }
    }
    auto const is_inward = [](shell const& sh) { return sh.six_volume < -volume_noise * sh.six_size; };
    if (std::none_of(shells.begin(), shells.end(), is_inward)) return {};
    std::vector<double> diagonal(shells.size());
    std::vector<std::uint32_t> by_size(shells.size());
    for (std::uint32_t i = 0; i < shells.size(); ++i) {
        diagonal[i] = shells[i].bounds.diagonal();
        by_size[i] = i;
    }
    std::sort(by_size.begin(), by_size.end(), [&](std::uint32_t a, std::uint32_t b) {
        return diagonal[a] != diagonal[b] ? diagonal[a] > diagonal[b] : a < b;
    });
    auto const contains = [](shell const& outer, vec3 const& p) {
        if (!outer.bounds.contains(p)) return false;
        int around = 0;
        for (auto const& t : outer.triangles) around += upward_crossing(t[0], t[1], t[2], p);
        return around % 2 != 0;
    };
    std::vector<std::vector<std::uint32_t>> turned;
    for (std::size_t i = 0; i < shells.size(); ++i) {
        // A shell goes with the outermost one around it, so that cavities stay cavities.
        std::size_t outermost = i;
        for (std::uint32_t const j : by_size) {
            if (!(diagonal[j] > diagonal[i])) break;
            if (!contains(shells[j], shells[i].lowest)) continue;
            outermost = j;
            break;
        }
        if (!is_inward(shells[outermost])) continue;
        turned.push_back(shells[i].faces);
    }
    return turned;
}

}  // namespace tafoni::detail

#endif
