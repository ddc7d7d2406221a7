/// \file
/// The steps of `repair_mesh`.
#ifndef TAFONI_GEOMETRY_DETAIL_MESH_MENDING_HPP
#define TAFONI_GEOMETRY_DETAIL_MESH_MENDING_HPP

#include <tafoni/geometry/detail/edge_faults.hpp>
#include <tafoni/geometry/detail/outward_shells.hpp>
#include <tafoni/geometry/detail/split_fans.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// A mesh on the bench. Every step leaves `vertex_of` and `face_of` in step with `mesh`.
class mesh_mender {
public:
    static constexpr std::uint32_t none = face_index::none;

    indexed_mesh mesh;
    std::vector<std::uint32_t> vertex_of{};
    std::vector<std::uint32_t> face_of{};

    explicit mesh_mender(indexed_mesh input)
        : mesh(std::move(input)), vertex_of(mesh.vertex_count()), face_of(mesh.face_count()) {
        for (std::uint32_t v = 0; v < vertex_of.size(); ++v) vertex_of[v] = v;
        for (std::uint32_t f = 0; f < face_of.size(); ++f) face_of[f] = f;
        turned_.assign(face_of.size(), 0);
    }

    /// Corners move to the first vertex at their place. O(n log n).
    std::vector<std::uint32_t> merge_vertices() {
        std::vector<std::uint32_t> order(mesh.vertex_count());
        for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
        std::sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
            vec3 const& p = mesh.positions[a];
            vec3 const& q = mesh.positions[b];
            if (lexicographically_less(p, q)) return true;
            if (lexicographically_less(q, p)) return false;
            return a < b;
        });
        std::vector<std::uint32_t> merged;
        std::vector<std::uint32_t> kept(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            bool const same = i > 0 && mesh.positions[order[i]] == mesh.positions[order[i - 1]];
            kept[order[i]] = same ? kept[order[i - 1]] : order[i];
            if (same) merged.push_back(order[i]);
        }
        for (std::uint32_t& c : mesh.corners) c = kept[c];
        std::sort(merged.begin(), merged.end());
        return merged;
    }

    /// Equal neighbours in a loop become one corner; a face with fewer than three, or one that still
    /// comes back to a vertex, goes. O(corners log (corners per face)).
    std::vector<std::uint32_t> drop_degenerate() {
        std::vector<std::uint32_t> changed;
        rebuild([&](std::size_t f, std::vector<std::uint32_t>& loop) {
            std::size_t const before = loop.size();
            loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
            while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
            auto sorted = loop;
            std::sort(sorted.begin(), sorted.end());
            bool const keep = loop.size() >= 3 && std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
            if (!keep || loop.size() != before) changed.push_back(face_of[f]);
            return keep;
        });
        return changed;
    }

    /// Of faces with one outline the first stays, or none where the edges are then even. O(sides).
    std::vector<std::uint32_t> drop_duplicates() {
        std::vector<std::uint8_t> gone(mesh.face_count(), 0);
        {
            edge_table const edges(mesh);
            auto const twins = duplicate_faces(mesh, edges);
            if (twins.empty()) return {};
            std::vector<std::uint32_t> sides_at(mesh.corners.size(), 0);
            edges.for_each_edge([&](std::uint32_t, std::span<edge_table::side const> sides) {
                for (auto const s : sides) sides_at[s.corner] = static_cast<std::uint32_t>(sides.size());
            });
            std::vector<std::uint32_t> copies(mesh.face_count(), 1);
            for (auto const& [first, later] : twins) {
                gone[later] = 1;
                ++copies[first];
            }
            for (std::size_t f = 0; f < mesh.face_count(); ++f) {
                if (copies[f] < 2) continue;
                std::size_t even = 0;
                for (std::size_t c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) {
                    even += (sides_at[c] - copies[f]) % 2 == 0 ? 1U : 0U;
                }
                if (2 * even > mesh.face(f).size()) gone[f] = 1;
            }
        }
        std::vector<std::uint32_t> dropped;
        rebuild([&](std::size_t f, std::vector<std::uint32_t>&) {
            if (gone[f] != 0) dropped.push_back(face_of[f]);
            return gone[f] == 0;
        });
        return dropped;
    }

    /// Turns faces until two-sided edges agree; in each connected part the fewer ones are turned. What
    /// cannot be oriented stays as it is. O(sides).
    void orient() {
        edge_table const edges(mesh);
        side_mates const mates(edges, mesh.corners.size());
        std::vector<std::uint8_t> state(mesh.face_count(), 2);
        std::vector<std::uint8_t> turn(mesh.face_count(), 0);
        std::vector<std::uint32_t> part;
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
            if (state[f] != 2) continue;
            state[f] = 0;
            part.assign(1, f);
            std::size_t turned = 0;
            bool orientable = true;
            for (std::size_t i = 0; i < part.size(); ++i) {
                turned += state[part[i]];
                for (std::size_t c = mesh.offsets[part[i]]; c < mesh.offsets[part[i] + 1]; ++c) {
                    if (mates.mate[c] == none) continue;
                    std::uint32_t const g = edges.face_of(mates.mate[c]);
                    std::uint8_t const wanted = static_cast<std::uint8_t>(state[part[i]] ^ mates.same_way[c]);
                    if (state[g] == 2) {
                        state[g] = wanted;
                        part.push_back(g);
                    } else if (state[g] != wanted) {
                        orientable = false;
                    }
                }
            }
            if (!orientable) continue;
            std::uint8_t const flip = 2 * turned > part.size() ? 1 : 0;
            for (std::uint32_t const g : part) turn[g] = static_cast<std::uint8_t>(state[g] ^ flip);
        }
        for (std::size_t f = 0; f < mesh.face_count(); ++f) {
            if (turn[f] != 0) turn_face(f);
        }
    }

    /// Pairs the sides at edges of more than two faces around their wedges of rock; returns how many edges. O(sides).
    std::size_t pair_crowded_edges();

    /// One vertex per fan; needs the pairing, which it makes when there is none yet. O(corners).
    std::vector<std::uint32_t> split_vertices() {
        auto const old_of = split_fans(mesh, pairing());
        std::vector<std::uint32_t> copies;
        for (std::size_t v = vertex_of.size(); v < old_of.size(); ++v) copies.push_back(vertex_of[old_of[v]]);
        vertex_of.insert(vertex_of.end(), copies.begin(), copies.end());
        std::sort(copies.begin(), copies.end());
        return copies;
    }

    /// Closes boundary loops of at most `most` edges that pass every vertex once; returns how many. O(sides).
    std::size_t fill_holes(std::size_t most);

    /// Turns shells of negative volume that lie in no other, with all that they contain; returns how many.
    std::size_t turn_outwards();

    /// Faces of the input that are turned an odd number of times, in rising order. O(faces).
    [[nodiscard]] std::vector<std::uint32_t> turned_faces() const {
        std::vector<std::uint32_t> r;
        for (std::size_t f = 0; f < face_of.size(); ++f) {
            if (turned_[f] != 0 && face_of[f] != none) r.push_back(face_of[f]);
        }
        return r;
    }

private:
    /// Keeps the faces for which `edit(face, loop)` is true, with the loop as edited.
    template <class Edit>
    void rebuild(Edit const& edit) {
        indexed_mesh r;
        std::vector<std::uint32_t> names;
        std::vector<std::uint8_t> turned;
        std::vector<std::uint32_t> loop;
        for (std::size_t f = 0; f < mesh.face_count(); ++f) {
            loop.assign(mesh.face(f).begin(), mesh.face(f).end());
            if (!edit(f, loop)) continue;
            r.add_face(loop);
            names.push_back(face_of[f]);
            turned.push_back(turned_[f]);
        }
        r.positions = std::move(mesh.positions);
        mesh = std::move(r);
        face_of = std::move(names);
        turned_ = std::move(turned);
    }

    /// Reverses a loop but for its first corner.
    void turn_face(std::size_t f) {
        auto const first = mesh.corners.begin() + static_cast<std::ptrdiff_t>(mesh.offsets[f]);
        std::reverse(first + 1, mesh.corners.begin() + static_cast<std::ptrdiff_t>(mesh.offsets[f + 1]));
        turned_[f] ^= 1;
    }

    std::vector<std::uint32_t> const& pairing() {
        if (!across_) {
            across_.emplace(mesh.corners.size(), none);
            (void)find_edge_faults(edge_table(mesh), mesh.vertex_count(), *across_);
        }
        return *across_;
    }

    std::vector<std::uint8_t> turned_{};
    std::optional<std::vector<std::uint32_t>> across_{};  ///< made once faces no longer change
};

inline std::size_t mesh_mender::pair_crowded_edges() {
    (void)pairing();
    edge_table const edges(mesh);
    struct spoke {
        double turn;  ///< grows with the angle, from 0 to 4; 0 for a face without area
        std::uint32_t corner;
        bool forward;
    };
    // A number per spoke and not a comparison of two: cross products that round to zero have no order.
    auto const turn_of = [](double x, double y) {
        double const size = std::fabs(x) + std::fabs(y);
        if (!(size > 0 && size <= std::numeric_limits<double>::max())) return 0.0;
        if (y >= 0) return x >= 0 ? y / size : 1 - x / size;
        return x < 0 ? 2 - y / size : 3 + x / size;
    };
    std::vector<spoke> spokes;
    std::vector<std::uint32_t> waiting;
    std::size_t count = 0;
    edges.for_each_edge([&](std::uint32_t low, std::span<edge_table::side const> sides) {
        if (sides.size() < 3) return;
        ++count;
        vec3 const a = mesh.positions[low];
        vec3 const b = mesh.positions[sides[0].high];
        vec3 const axis = normalized(vec3{b[0] - a[0], b[1] - a[1], b[2] - a[2]});
        int least = 0;
        for (int i = 1; i < 3; ++i) {
            if (std::fabs(axis[i]) < std::fabs(axis[least])) least = i;
        }
        vec3 pole{0, 0, 0};
        pole[least] = 1;
        vec3 const u = normalized(cross(axis, pole));
        vec3 const w = cross(axis, u);
        spokes.clear();
        for (auto const s : sides) {
            // The direction from the edge into the face: its area vector times the direction of the side.
            vec3 normal{0, 0, 0};
            auto const loop = mesh.face(edges.face_of(s.corner));
            for (std::size_t k = 2; k < loop.size(); ++k) {
                vec3 const& o = mesh.positions[loop[0]];
                vec3 const& p = mesh.positions[loop[k - 1]];
                vec3 const& q = mesh.positions[loop[k]];
                vec3 const c = cross(vec3{p[0] - o[0], p[1] - o[1], p[2] - o[2]},
                                     vec3{q[0] - o[0], q[1] - o[1], q[2] - o[2]});
                normal = vec3{normal[0] + c[0], normal[1] + c[1], normal[2] + c[2]};
            }
            bool const forward = edges.forward(s);
            vec3 const into = cross(normal, axis);
            double const sign = forward ? 1 : -1;
            spokes.push_back({turn_of(sign * dot(into, u), sign * dot(into, w)), s.corner, forward});
        }
        std::sort(spokes.begin(), spokes.end(), [](spoke const& s, spoke const& t) {
            return s.turn != t.turn ? s.turn < t.turn : s.corner < t.corner;
        });
        // Counter-clockwise about the edge a wedge of rock opens with a backward side and ends with a
        // forward one; going round twice lets a wedge reach over the start.
        waiting.clear();
        for (std::size_t i = 0; i < 2 * spokes.size(); ++i) {
            spoke const& s = spokes[i % spokes.size()];
            if (across_->at(s.corner) != none) continue;
            if (!s.forward) {
                if (i < spokes.size()) waiting.push_back(s.corner);
            } else if (!waiting.empty()) {
                (*across_)[s.corner] = waiting.back();
                (*across_)[waiting.back()] = s.corner;
                waiting.pop_back();
            }
        }
    });
    return count;
}

inline std::size_t mesh_mender::fill_holes(std::size_t most) {
    std::vector<std::uint32_t> const& across = pairing();
    std::vector<std::uint32_t> next(mesh.vertex_count(), none);
    std::vector<std::uint32_t> beside(mesh.vertex_count(), none);  // the face at the open side that starts here
    std::vector<std::uint8_t> busy(mesh.vertex_count(), 0);
    std::vector<std::uint32_t> starts;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        for (std::size_t c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) {
            if (across[c] != none) continue;
            std::uint32_t const from = mesh.corners[c];
            std::uint32_t const to = mesh.corners[c + 1 == mesh.offsets[f + 1] ? mesh.offsets[f] : c + 1];
            if (next[to] != none) busy[to] = 1;
            next[to] = from;
            beside[to] = static_cast<std::uint32_t>(f);
            starts.push_back(to);
        }
    }
    std::size_t filled = 0;
    std::vector<std::uint8_t> walked(mesh.vertex_count(), 0);
    std::vector<std::uint32_t> loop;
    for (std::uint32_t const start : starts) {
        loop.clear();
        std::uint32_t v = start;
        while (v != none && walked[v] == 0 && busy[v] == 0) {
            walked[v] = 1;
            loop.push_back(v);
            v = next[v];
        }
        if (v != start || loop.size() < 3 || loop.size() > most || busy[start] != 0) continue;
        // A face that stands alone is no hole: its other side would be a duplicate of it.
        std::uint32_t const f = beside[start];
        if (mesh.face(f).size() == loop.size() &&
            std::all_of(loop.begin(), loop.end(), [&](std::uint32_t w) { return beside[w] == f; })) {
            continue;
        }
        mesh.add_face(loop);
        face_of.push_back(none);
        turned_.push_back(0);
        ++filled;
    }
    if (filled > 0) across_.reset();
    return filled;
}

inline std::size_t mesh_mender::turn_outwards() {
    auto const inward = inward_shells(mesh, pairing());
    if (inward.empty()) return 0;
    // A part that could not be oriented has no outside; it stays as it is.
    side_mates const mates(edge_table(mesh), mesh.corners.size());
    auto const agrees = [&](std::uint32_t f) {
        for (std::size_t c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) {
            if (mates.same_way[c] != 0) return false;
        }
        return true;
    };
    std::size_t count = 0;
    for (auto const& shell : inward) {
        if (!std::all_of(shell.begin(), shell.end(), agrees)) continue;
        for (std::uint32_t const f : shell) turn_face(f);
        ++count;
    }
    if (count > 0) across_.reset();
    return count;
}

}  // namespace tafoni::detail

#endif
