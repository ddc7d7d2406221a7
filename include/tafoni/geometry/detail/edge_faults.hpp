/// \file
/// Pairs the sides of faces at their edges, or says what keeps them from pairing.
#ifndef TAFONI_GEOMETRY_DETAIL_EDGE_FAULTS_HPP
#define TAFONI_GEOMETRY_DETAIL_EDGE_FAULTS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/detail/edge_table.hpp>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// A face as a closed run of vertices that starts at its lowest one.
[[nodiscard]] inline std::vector<std::uint32_t> canonical_loop(std::span<std::uint32_t const> loop) {
    std::vector<std::uint32_t> r(loop.begin(), loop.end());
    std::rotate(r.begin(), std::min_element(r.begin(), r.end()), r.end());
    return r;
}

/// The same run of vertices, in either direction.
[[nodiscard]] inline bool same_outline(std::span<std::uint32_t const> a, std::span<std::uint32_t const> b) {
    if (a.size() != b.size()) return false;
    auto const x = canonical_loop(a);
    auto y = canonical_loop(b);
    if (x == y) return true;
    std::reverse(y.begin() + 1, y.end());
    return x == y;
}

/// Pairs (earlier, later) of faces with the same outline; each later face is named once. O(sides).
[[nodiscard]] inline std::vector<std::pair<std::uint32_t, std::uint32_t>> duplicate_faces(indexed_mesh const& mesh,
                                                                                         edge_table const& edges) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    // A key that does not depend on start or direction, so that only faces with equal keys are compared.
    std::vector<std::uint64_t> key(mesh.face_count(), 0);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        for (std::uint32_t const v : mesh.face(f)) {
            std::uint64_t x = (v + 1ULL) * 0x9E3779B97F4A7C15ULL;
            x = (x ^ (x >> 29)) * 0xBF58476D1CE4E5B9ULL;
            key[f] += x ^ (x >> 32);
        }
    }
    std::vector<std::pair<std::uint64_t, std::uint32_t>> here;
    edges.for_each_edge([&](std::uint32_t, std::span<edge_table::side const> sides) {
        if (sides.size() < 2) return;
        if (sides.size() == 2 && key[edges.face_of(sides[0].corner)] != key[edges.face_of(sides[1].corner)]) return;
        here.clear();
        for (auto const s : sides) here.push_back({key[edges.face_of(s.corner)], edges.face_of(s.corner)});
        std::sort(here.begin(), here.end());
        std::size_t first = 0;
        for (std::size_t i = 1; i < here.size(); ++i) {
            if (here[i].first != here[first].first) first = i;
            else if (same_outline(mesh.face(here[first].second), mesh.face(here[i].second))) {
                found.push_back({here[first].second, here[i].second});
            }
        }
    });
    std::sort(found.begin(), found.end(), [](auto const& a, auto const& b) {
        return a.second != b.second ? a.second < b.second : a.first < b.first;
    });
    found.erase(std::unique(found.begin(), found.end(),
                            [](auto const& a, auto const& b) { return a.second == b.second; }),
                found.end());
    return found;
}

/// Edges that do not join exactly two sides of opposite directions, each named by its first side.
struct edge_faults {
    std::vector<std::uint32_t> open{};          ///< one side
    std::vector<std::uint32_t> crowded{};       ///< more than two sides
    std::vector<std::uint32_t> same_way{};      ///< two sides in the same direction
    std::size_t boundary_loops = 0;             ///< connected runs of open edges
};

/// Pairs what pairs (`across`, none elsewhere) and lists the rest. O(sides).
[[nodiscard]] inline edge_faults find_edge_faults(edge_table const& edges, std::size_t vertex_count,
                                                  std::vector<std::uint32_t>& across) {
    edge_faults r;
    edges.for_each_edge([&](std::uint32_t, std::span<edge_table::side const> sides) {
        std::uint32_t const first = sides[0].corner;
        if (sides.size() == 1) r.open.push_back(first);
        else if (sides.size() > 2) r.crowded.push_back(first);
        else if (edges.forward(sides[0]) == edges.forward(sides[1])) r.same_way.push_back(first);
        else {
            across[first] = sides[1].corner;
            across[sides[1].corner] = first;
        }
    });
    for (auto* list : {&r.open, &r.crowded, &r.same_way}) std::sort(list->begin(), list->end());
    if (!r.open.empty()) {
        disjoint_sets ends(vertex_count);
        for (std::uint32_t const c : r.open) ends.join(edges.from(c), edges.to(c));
        std::vector<std::uint32_t> roots;
        for (std::uint32_t const c : r.open) roots.push_back(ends.root(edges.from(c)));
        std::sort(roots.begin(), roots.end());
        r.boundary_loops = static_cast<std::size_t>(std::unique(roots.begin(), roots.end()) - roots.begin());
    }
    return r;
}

/// For each side of an edge of two sides the other one, and whether both run the same way.
struct side_mates {
    std::vector<std::uint32_t> mate;     ///< the largest number for sides of other edges
    std::vector<std::uint8_t> same_way;  ///< 1 where one of the two faces has to be turned

    side_mates(edge_table const& edges, std::size_t sides_count)
        : mate(sides_count, std::numeric_limits<std::uint32_t>::max()), same_way(sides_count, 0) {
        edges.for_each_edge([&](std::uint32_t, std::span<edge_table::side const> sides) {
            if (sides.size() != 2) return;
            mate[sides[0].corner] = sides[1].corner;
            mate[sides[1].corner] = sides[0].corner;
            bool const same = edges.forward(sides[0]) == edges.forward(sides[1]);
            same_way[sides[0].corner] = same_way[sides[1].corner] = same ? 1 : 0;
        });
    }
};

/// True when no choice of directions makes the sides of every two-sided edge run against each other.
/// Faces are walked in order with an explicit stack. O(sides).
[[nodiscard]] inline bool cannot_be_oriented(indexed_mesh const& mesh, edge_table const& edges) {
    struct step {
        std::uint32_t face;
        std::uint8_t turned;
    };
    side_mates const mates(edges, mesh.corners.size());
    std::vector<std::uint8_t> state(mesh.face_count(), 2);
    std::vector<step> stack;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        if (state[f] != 2) continue;
        state[f] = 0;
        stack.push_back({f, 0});
        while (!stack.empty()) {
            step const s = stack.back();
            stack.pop_back();
            for (std::size_t c = mesh.offsets[s.face]; c < mesh.offsets[s.face + 1]; ++c) {
                if (mates.mate[c] == std::numeric_limits<std::uint32_t>::max()) continue;
                std::uint32_t const g = edges.face_of(mates.mate[c]);
                std::uint8_t const turned = static_cast<std::uint8_t>(s.turned ^ mates.same_way[c]);
                if (state[g] == 2) {
                    state[g] = turned;
                    stack.push_back({g, turned});
                } else if (state[g] != turned) {
                    return true;
                }
            }
        }
    }
    return false;
}

/// Names an edge in a message: "from vertex 3 to 17 (face 12)".
[[nodiscard]] inline std::string edge_text(edge_table const& edges, std::uint32_t corner) {
    return "from vertex " + std::to_string(edges.from(corner)) + " to " + std::to_string(edges.to(corner)) +
           " (face " + std::to_string(edges.face_of(corner)) + ")";
}

/// Side -> the side across its edge; throws where the mesh is not closed, oriented and free of duplicates. O(sides).
[[nodiscard]] inline std::vector<std::uint32_t> paired_sides(char const* who, indexed_mesh const& mesh) {
    edge_table const edges(mesh);
    auto const twins = duplicate_faces(mesh, edges);
    if (!twins.empty()) {
        fail<bad_topology>(errc::duplicate_face,
                           std::string(who) + ": face " + std::to_string(twins[0].second) +
                               " has the same vertices as face " + std::to_string(twins[0].first) + "; " +
                               std::to_string(twins.size()) + " such in all",
                           {.kind = entity::face,
                            .index = twins[0].second,
                            .value = static_cast<double>(twins.size()),
                            .limit = 0});
    }
    std::vector<std::uint32_t> across(mesh.corners.size(), std::numeric_limits<std::uint32_t>::max());
    edge_faults const faults = find_edge_faults(edges, mesh.vertex_count(), across);
    auto const refuse = [&](errc code, std::vector<std::uint32_t> const& list, std::string const& text) {
        fail<bad_topology>(code, std::string(who) + ": " + std::to_string(list.size()) + text + edge_text(edges, list[0]),
                           {.kind = entity::edge,
                            .index = list[0],
                            .value = static_cast<double>(list.size()),
                            .limit = 0});
    };
    if (!faults.crowded.empty()) {
        refuse(errc::nonmanifold_edge, faults.crowded, " edges with more than two faces, the first ");
    }
    if (!faults.same_way.empty()) {
        bool const hopeless = cannot_be_oriented(mesh, edges);
        refuse(hopeless ? errc::non_orientable : errc::inconsistent_orientation, faults.same_way,
               std::string(" edges whose two faces run the same way") +
                   (hopeless ? " and no turning of faces can mend it" : "") + ", the first ");
    }
    if (!faults.open.empty()) {
        refuse(errc::not_closed, faults.open,
               " open edges in " + std::to_string(faults.boundary_loops) + " loops, the first ");
    }
    return across;
}

}  // namespace tafoni::detail

#endif
