/// \file
/// The laws of a shard complex, recomputed from its loops alone.
#ifndef TAFONI_TESTS_SUPPORT_SHARD_LAWS_HPP
#define TAFONI_TESTS_SUPPORT_SHARD_LAWS_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/core/sum.hpp>
#include <tafoni/decomposition/locate.hpp>
#include <tafoni/decomposition/shard_complex.hpp>
#include <tafoni/geometry/solid.hpp>
#include <tafoni/geometry/winding_number.hpp>

#include <algorithm>
#include <cstdint>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace tafoni_test {

using tafoni::vec3;

struct law_options {
    bool embedded = true;         ///< the solid's surface does not cut itself
    std::size_t points = 300;     ///< for the law of the nearest site
    double tolerance = 1e-9;      ///< of the model's volume, area or size
};

/// What one face adds, from its loops: area vector and six times the volume of cones from `apex`.
struct face_sums {
    vec3 area{0, 0, 0};
    double six_volumes = 0;
};

inline face_sums sum_face(tafoni::shard_complex const& c, std::uint32_t f, vec3 const& apex) {
    face_sums s;
    for (std::size_t l = 0; l < c.loop_count(tafoni::face_index{f}); ++l) {
        auto const loop = c.face_loop(tafoni::face_index{f}, l);
        for (std::size_t k = 0; k < loop.size(); ++k) {
            vec3 const o = c.position(loop[0]) - apex;
            vec3 const a = c.position(loop[k]) - apex;
            vec3 const b = c.position(loop[k + 1 == loop.size() ? 0 : k + 1]) - apex;
            s.six_volumes += tafoni::dot(o, tafoni::cross(a, b));
            s.area += 0.5 * tafoni::cross(vec3(a - o), vec3(b - o));
        }
    }
    return s;
}

/// The laws that `c` breaks, in words; empty when it keeps them all.
inline std::vector<std::string> broken_laws(tafoni::solid const& body, tafoni::shard_complex const& c,
                                            law_options const& options = {}) {
    std::vector<std::string> broken;
    auto const report = [&broken](auto const&... parts) {
        std::ostringstream text;
        (text << ... << parts);
        if (broken.size() < 20) broken.push_back(text.str());
    };
    double const size = c.model_size();
    double const total = tafoni::pairwise_sum(0, c.cell_count(), [&](std::size_t k) { return c.volumes[k]; });
    if (!(std::fabs(total - body.volume) <= options.tolerance * body.volume)) {
        report("law 1: volumes add up to ", total, ", the solid has ", body.volume);
    }
    double skin = 0;
    for (std::size_t f = c.interior_face_count; f < c.face_count(); ++f) {
        skin += tafoni::length(sum_face(c, static_cast<std::uint32_t>(f), c.position(c.face_loop(tafoni::face_index{f}, 0)[0])).area);
        if (c.faces[f].back.valid()) report("skin face ", f, " has a back");
        if (c.face_source(tafoni::face_index{f}) >= body.triangles.size()) report("skin face ", f, " has no source");
    }
    if (!(std::fabs(skin - body.area) <= options.tolerance * body.area)) {
        report("law 6: skin of ", skin, ", the solid's surface has ", body.area);
    }
    std::vector<std::pair<std::uint64_t, int>> edges;
    for (std::uint32_t k = 0; k < c.cell_count(); ++k) {
        tafoni::cell_index const cell{k};
        vec3 const apex = c.centroids[k];
        vec3 area{0, 0, 0};
        double six = 0;
        edges.clear();
        for (std::uint32_t f : c.faces_of(cell)) {
            bool const front = c.faces[f].front == cell;
            if (!front && c.faces[f].back != cell) report("face ", f, " is listed at a cell that it does not bound");
            face_sums const s = sum_face(c, f, apex);
            area += (front ? 1.0 : -1.0) * s.area;
            six += (front ? 1.0 : -1.0) * s.six_volumes;
            for (std::size_t l = 0; l < c.loop_count(tafoni::face_index{f}); ++l) {
                auto const loop = c.face_loop(tafoni::face_index{f}, l);
                if (loop.size() < 3) report("face ", f, " has a loop of ", loop.size(), " corners");
                for (std::size_t e = 0; e < loop.size(); ++e) {
                    std::uint64_t a = loop[e].value;
                    std::uint64_t b = loop[e + 1 == loop.size() ? 0 : e + 1].value;
                    int const way = (a < b) == front ? 1 : -1;
                    edges.push_back({a < b ? a << 32 | b : b << 32 | a, way});
                }
            }
        }
        std::sort(edges.begin(), edges.end());
        for (std::size_t e = 0; e < edges.size();) {
            std::size_t const first = e;
            int sum = 0;
            for (; e < edges.size() && edges[e].first == edges[first].first; ++e) sum += edges[e].second;
            if (sum != 0) report("law 5: cell ", k, " is not closed along an edge");
        }
        if (!(tafoni::length(area) <= options.tolerance * size * size)) report("law 2: cell ", k, " has area vectors of ", tafoni::length(area));
        if (!(std::fabs(six / 6 - c.volumes[k]) <= options.tolerance * body.volume)) {
            report("law 1: cell ", k, " says ", c.volumes[k], ", its loops enclose ", six / 6);
        }
        if (options.embedded && !(c.volumes[k] > 0)) report("law 5: cell ", k, " has volume ", c.volumes[k]);
    }
    bool const merged = c.merged_slivers != 0;
    for (std::uint32_t f = 0; f < c.interior_face_count; ++f) {
        auto const& face = c.faces[f];
        if (!face.back.valid() || face.front == face.back) {
            report("law 3: interior face ", f, " does not lie between two cells");
            continue;
        }
        if (merged) continue;
        vec3 const p = c.sites[c.site_of[face.front.value].value];
        vec3 const q = c.sites[c.site_of[face.back.value].value];
        vec3 const n = q - p;
        vec3 const middle = p + 0.5 * n;
        double const distance = tafoni::length(n);
        for (std::size_t l = 0; l < c.loop_count(tafoni::face_index{f}); ++l) {
            for (auto v : c.face_loop(tafoni::face_index{f}, l)) {
                // Sites that almost coincide define their bisector no better than the lattice does.
                double const off = std::fabs(tafoni::dot(vec3(c.position(v) - middle), n)) / distance;
                if (off > options.tolerance * size && off * distance > 1e-15 * size * size) report("law 2: face ", f, " is ", off, " off its bisector");
            }
        }
    }
    tafoni::shard_locator const locate(c);
    tafoni::stream draw(11, tafoni::stage::user, 0);
    for (std::size_t k = 0; k < options.points && options.embedded; ++k) {
        vec3 x{0, 0, 0};
        for (int a = 0; a < 3; ++a) x[a] = draw.uniform(body.bounds.lo[a], body.bounds.hi[a]);
        bool const inside = tafoni::winding_number(body, x) != 0;
        tafoni::cell_index const shard = locate(x);
        if (inside != shard.valid()) {
            report("law 4: a point ", inside ? "inside" : "outside", " lies in ", shard.valid() ? "a shard" : "no shard");
            continue;
        }
        if (!inside || merged) continue;
        double best = std::numeric_limits<double>::infinity();
        for (std::uint32_t s = 0; s < c.sites.size(); ++s) {
            if (c.shards_of(tafoni::site_index{s}).empty()) continue;  // dropped, or without a share of the solid
            best = std::min(best, tafoni::length(vec3(x - c.sites[s])));
        }
        double const own = tafoni::length(vec3(x - c.sites[c.site_of[shard.value].value]));
        if (own > best + options.tolerance * size) report("law 4: a point lies ", own - best, " nearer to another site");
    }
    return broken;
}

}  // namespace tafoni_test

#endif
