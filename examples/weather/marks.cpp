#include "marks.hpp"

#include "input.hpp"
#include "spec.hpp"

#include <tafoni/core/elementary.hpp>
#include <tafoni/geometry/inside_columns.hpp>
#include <tafoni/geometry/repair_solid.hpp>
#include <tafoni/io/read_mesh.hpp>

#include <algorithm>

namespace weather {

using namespace tafoni;

namespace {

template <class Predicate>
std::vector<cell_index> cells_where(shard_complex const& shards, Predicate const& predicate) {
    std::vector<cell_index> r;
    for (std::size_t c = 0; c < shards.cell_count(); ++c) {
        if (predicate(cell_index{c})) r.push_back(cell_index{c});
    }
    return r;
}

/// Cells that own artificial skin: the sides and the base of a terrain.
bool is_artificial(shard_complex const& shards, cell_index c) {
    for (std::uint32_t const f : shards.faces_of(c)) {
        if (!shards.faces[f].back.valid() && !shards.face_patch(tafoni::face_index{f}).valid()) return true;
    }
    return false;
}

std::vector<cell_index> cells_of_file(spec& s, shard_complex const& shards) {
    std::string const path = s.word("path", "");
    if (path.empty()) s.fail("path: a mesh or a list of cell numbers is needed");
    if (is_mesh_name(path)) {
        repaired_solid const region = repair_solid(read_mesh(std::filesystem::path(path)).mesh, {.orient = true});
        inside_columns const inside(region.body);
        return cells_where(shards, [&](cell_index c) { return inside.contains(shards.cell_centroid(c)); });
    }
    std::vector<cell_index> r;
    for (std::uint64_t const n : load_numbers(path)) {
        if (n >= shards.cell_count()) {
            detail::fail<invalid_input>(errc::index_out_of_range,
                                        path + ": cell " + std::to_string(n) + " of " + std::to_string(shards.cell_count()),
                                        {.kind = entity::cell, .index = n});
        }
        r.push_back(cell_index{n});
    }
    return r;
}

}  // namespace

std::vector<cell_index> choose_cells(std::string const& option, std::string const& text, shard_complex const& shards,
                                     link_graph const& links, vec3 const& up) {
    spec s = spec::parse(option, text);
    std::vector<cell_index> cells;
    if (s.name() == "none") {
        s.done();
    } else if (s.name() == "all") {
        s.done();
        cells = cells_where(shards, [](cell_index) { return true; });
    } else if (s.name() == "plane") {
        // The half-space that the normal points into.
        vec3 const point = s.vector("point", {0, 0, 0});
        vec3 const normal = s.direction("normal", vec3{-up});
        s.done();
        cells = cells_where(shards, [&](cell_index c) { return dot(shards.cell_centroid(c) - point, normal) >= 0; });
    } else if (s.name() == "box") {
        box3 const box{s.vector("lo", {1, 1, 1}), s.vector("hi", {-1, -1, -1})};
        s.done();
        if (box.empty()) s.fail("lo must not exceed hi");
        cells = cells_where(shards, [&](cell_index c) { return box.contains(shards.cell_centroid(c)); });
    } else if (s.name() == "bottom") {
        double const share = s.number("share", 0.1, 0, 1);
        s.done();
        double lo = 0;
        double hi = 0;
        for (std::size_t v = 0; v < shards.vertex_count(); ++v) {
            double const altitude = dot(up, shards.vertices[v]);
            lo = v == 0 ? altitude : std::min(lo, altitude);
            hi = v == 0 ? altitude : std::max(hi, altitude);
        }
        cells = cells_where(shards, [&](cell_index c) { return dot(up, shards.cell_centroid(c)) <= lo + share * (hi - lo); });
    } else if (s.name() == "exterior" || s.name() == "exterior-except") {
        bool const except = s.name() == "exterior-except";
        vec3 const direction = except ? s.direction("direction", {0, -1, 0}) : up;
        double const cosine = except ? elementary::cos(s.number("angle", 60, 0, 180) * 0.017453292519943295) : 2;
        s.done();
        cells = cells_where(shards, [&](cell_index c) {
            bool outside = is_artificial(shards, c);
            bool facing = false;
            for (link_index const l : links.links_of(c)) {
                if (links.is_interior(l)) continue;
                outside = true;
                facing = facing || dot(links.link_normal(l), direction) >= cosine;
            }
            return outside && !facing;
        });
    } else if (s.name() == "artificial") {
        s.done();
        cells = cells_where(shards, [&](cell_index c) { return is_artificial(shards, c); });
    } else if (s.name() == "file") {
        cells = cells_of_file(s, shards);
        s.done();
    } else {
        s.fail("known: none, all, plane, box, bottom, exterior, exterior-except, artificial, file");
    }
    return cells;
}

}  // namespace weather
