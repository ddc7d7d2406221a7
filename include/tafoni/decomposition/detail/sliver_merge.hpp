/// \file
/// Gives shards that are too small to matter to a neighbour.
#ifndef TAFONI_DECOMPOSITION_DETAIL_SLIVER_MERGE_HPP
#define TAFONI_DECOMPOSITION_DETAIL_SLIVER_MERGE_HPP

#include <tafoni/decomposition/detail/complex_assembly.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Merges every shard of at most `least` volume into the neighbour that it shares the most area with
/// (into another shard of its site when it has no neighbour and no volume), the smallest first, until none
/// is left that has a neighbour. The faces between the two vanish. Sets merged_slivers; returns where the
/// slivers went. O(cells) without slivers, O(corners log corners) expected with.
[[nodiscard]] inline std::vector<moved_part> merge_slivers(shard_complex& c, double least) {
    using entry = std::pair<double, std::uint32_t>;
    std::vector<entry> slivers;
    for (std::uint32_t k = 0; k < c.volumes.size(); ++k) {
        if (!(c.volumes[k] > least)) slivers.push_back({c.volumes[k], k});
    }
    if (slivers.empty()) return {};
    auto const later = std::greater<entry>{};
    std::make_heap(slivers.begin(), slivers.end(), later);
    std::vector<std::uint32_t> into(c.volumes.size());
    std::vector<std::uint32_t> next(c.volumes.size());  // shards that were merged form a ring
    for (std::uint32_t k = 0; k < into.size(); ++k) into[k] = next[k] = k;
    auto const root = [&into](std::uint32_t k) {
        while (into[k] != k) {
            into[k] = into[into[k]];
            k = into[k];
        }
        return k;
    };
    auto const places = [&c](vertex_index v) { return c.vertices[v.value]; };
    std::vector<std::pair<std::uint32_t, double>> shared;
    while (!slivers.empty()) {
        std::pop_heap(slivers.begin(), slivers.end(), later);
        auto const [volume, s] = slivers.back();
        slivers.pop_back();
        if (into[s] != s || c.volumes[s] != volume) continue;
        shared.clear();
        std::uint32_t member = s;
        do {
            for (std::uint32_t f : c.faces_of(cell_index{member})) {
                if (!c.faces[f].back.valid()) continue;
                std::uint32_t const other = root(c.faces[f].front.value == member ? c.faces[f].back.value : c.faces[f].front.value);
                if (other == s) continue;
                vec3 sum{0, 0, 0};
                for (std::size_t l = 0; l < c.loop_count(face_index{f}); ++l) {
                    vec3 const a = doubled_area(c.face_loop(face_index{f}, l), places);
                    sum = vec3{sum[0] + a[0], sum[1] + a[1], sum[2] + a[2]};
                }
                shared.push_back({other, length(sum)});
            }
            member = next[member];
        } while (member != s);
        std::sort(shared.begin(), shared.end());
        std::uint32_t best = no_id;
        double best_area = -1;
        for (std::size_t k = 0; k < shared.size();) {
            std::uint32_t const other = shared[k].first;
            double area = 0;
            for (; k < shared.size() && shared[k].first == other; ++k) area += shared[k].second;
            if (area > best_area) {
                best = other;
                best_area = area;
            }
        }
        if (best == no_id && !(volume > 0)) {
            for (cell_index other : c.shards_of(c.site_of[s])) {
                std::uint32_t const o = root(other.value);
                if (o != s && (best == no_id || c.volumes[o] > c.volumes[best])) best = o;
            }
        }
        if (best == no_id) continue;
        into[s] = best;
        std::swap(next[s], next[best]);
        double const whole = c.volumes[best] + volume;
        if (whole > 0) {
            double const share = volume / whole;
            vec3 const& p = c.centroids[best];
            vec3 const& q = c.centroids[s];
            c.centroids[best] = vec3{p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]), p[2] + share * (q[2] - p[2])};
        }
        c.volumes[best] = whole;
        ++c.merged_slivers;
        if (!(whole > least)) {
            slivers.push_back({whole, best});
            std::push_heap(slivers.begin(), slivers.end(), later);
        }
    }
    if (c.merged_slivers == 0) return {};

    std::vector<std::uint32_t> number(into.size(), no_id);
    std::uint32_t kept = 0;
    std::vector<site_index> const old_site_of = c.site_of;
    for (std::uint32_t k = 0; k < into.size(); ++k) {
        if (into[k] != k) continue;
        number[k] = kept;
        c.volumes[kept] = c.volumes[k];
        c.centroids[kept] = c.centroids[k];
        c.site_of[kept++] = c.site_of[k];
    }
    std::vector<moved_part> moved;
    for (std::uint32_t k = 0; k < into.size(); ++k) {
        if (into[k] != k) moved.push_back({old_site_of[k], cell_index{number[root(k)]}});
    }
    c.volumes.resize(kept);
    c.centroids.resize(kept);
    c.site_of.resize(kept);

    shard_complex old;
    old.faces.swap(c.faces);
    old.face_begin.swap(c.face_begin);
    old.loop_begin.swap(c.loop_begin);
    old.corners.swap(c.corners);
    c.face_begin.assign(1, 0);
    c.loop_begin.assign(1, 0);
    std::size_t const inside = c.interior_face_count;
    c.interior_face_count = 0;
    for (std::uint32_t f = 0; f < old.faces.size(); ++f) {
        auto face = old.faces[f];
        face.front = cell_index{number[root(face.front.value)]};
        if (face.back.valid()) face.back = cell_index{number[root(face.back.value)]};
        if (face.front == face.back) continue;
        if (f < inside) ++c.interior_face_count;
        c.faces.push_back(face);
        for (std::size_t l = 0; l < old.loop_count(face_index{f}); ++l) {
            auto const loop = old.face_loop(face_index{f}, l);
            c.corners.insert(c.corners.end(), loop.begin(), loop.end());
            c.loop_begin.push_back(c.corners.size());
        }
        c.face_begin.push_back(static_cast<std::uint32_t>(c.loop_begin.size() - 1));
    }
    index_cell_faces(c);
    return moved;
}

}  // namespace tafoni::detail

#endif
