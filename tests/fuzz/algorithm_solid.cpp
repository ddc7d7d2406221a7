// Bytes make a mesh, mostly a broken one: make_solid and repair_mesh answer with their errors or keep their promises.
#include "check_mesh_file.hpp"
#include "reliability/cases.hpp"

#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/inspect_mesh.hpp>
#include <tafoni/geometry/repair_mesh.hpp>

namespace {

using namespace tafoni;
using tafoni_test::choices;
using tafoni_test::require;

/// A proper solid with some damage, or corners at random.
indexed_mesh damaged_mesh(choices& c) {
    indexed_mesh m;
    if (c.chance(0.7)) {
        std::string name;
        m = tafoni_test::random_shape(c, name);
    } else {
        std::size_t const n = c.below(12);
        for (std::size_t v = 0; v < n; ++v) {
            m.add_vertex(vec3{static_cast<double>(c.below(4)), static_cast<double>(c.below(4)), static_cast<double>(c.below(4))});
        }
        std::size_t const faces = c.below(20);
        for (std::size_t f = 0; f < faces && n > 0; ++f) {
            std::vector<std::uint32_t> loop(c.below(7));
            for (auto& v : loop) v = static_cast<std::uint32_t>(c.below(n));
            m.add_face(loop);
        }
    }
    std::size_t const damage = c.below(6);
    for (std::size_t k = 0; k < damage && m.face_count() > 0; ++k) {
        indexed_mesh r;
        r.positions = m.positions;
        std::size_t const f0 = c.below(m.face_count());
        auto const v = static_cast<std::uint32_t>(c.below(m.vertex_count()));
        std::uint64_t const kind = c.below(10);
        for (std::size_t f = 0; f < m.face_count(); ++f) {
            std::vector<std::uint32_t> loop(m.face(f).begin(), m.face(f).end());
            if (f == f0) {
                switch (kind) {
                    case 0: continue;                                     // a hole
                    case 1: std::reverse(loop.begin(), loop.end()); break;
                    case 2: r.add_face(loop); break;                      // twice
                    case 3: if (!loop.empty()) loop[0] = v; break;
                    case 4: if (!loop.empty()) loop.push_back(loop[0]); break;
                    case 5: {                                             // and its other side
                        r.add_face(loop);
                        std::reverse(loop.begin(), loop.end());
                        break;
                    }
                    case 6: if (!loop.empty()) loop.pop_back(); break;
                    default: break;
                }
            }
            r.add_face(loop);
        }
        if (kind == 7) r.positions[v] = r.positions[c.below(r.vertex_count())];  // two vertices at one place
        if (kind == 8) {                                                       // a vertex of its own
            r.add_vertex(r.positions[v]);
            std::size_t const at = c.below(r.corners.size() + 1);
            if (at < r.corners.size()) r.corners[at] = static_cast<std::uint32_t>(r.vertex_count() - 1);
        }
        if (kind == 9) {
            double const odd[] = {1e308, -1e308, 1e-308, std::nan(""), std::numeric_limits<double>::infinity(), 1e30, -0.0};
            r.positions[v][static_cast<Eigen::Index>(c.below(3))] = odd[c.below(7)];
            if (c.chance(0.2) && !r.corners.empty()) r.corners[c.below(r.corners.size())] += 1U << c.below(32);
        }
        m = std::move(r);
    }
    if (c.chance(0.2)) tafoni_test::append(m, indexed_mesh(m));
    return m;
}

/// What a solid promises.
void check_solid(indexed_mesh const& m, solid const& s) {
    require(s.volume > 0 && std::isfinite(s.volume), "volume is positive and finite");
    require(s.area > 0 && std::isfinite(s.area), "area is positive and finite");
    require(s.positions.size() == m.vertex_count() && s.polygon_count == m.face_count(), "vertices and faces keep their numbers");
    require(s.opposite.size() == 3 * s.triangles.size() && s.polygon_of.size() == s.triangles.size(), "arrays are parallel");
    for (std::uint32_t h = 0; h < s.opposite.size(); ++h) {
        std::uint32_t const o = s.opposite[h];
        require(o < s.opposite.size() && o != h && s.opposite[o] == h, "opposites go both ways");
        auto const from = [&](std::uint32_t k) { return s.triangles[k / 3][k % 3]; };
        auto const to = [&](std::uint32_t k) { return s.triangles[k / 3][(k % 3 + 1) % 3]; };
        require(from(h) == to(o) && to(h) == from(o), "opposites run the other way");
    }
}

template <class F>
bool refused(F const& f) {
    try {
        f();
        return false;
    } catch (invalid_input const& e) {
        require(e.code() != errc{}, "errors have a code");
        return true;
    } catch (bad_topology const& e) {
        require(e.code() != errc{}, "errors have a code");
        return true;
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    choices c(std::span(bytes, size));
    indexed_mesh const m = damaged_mesh(c);
    indexed_mesh const copy = m;
    solid s;
    bool const broken = refused([&] { s = make_solid(m); });
    if (!broken) check_solid(m, s);
    (void)refused([&] { (void)inspect_mesh(m); });
    repair_options const options{.merge_vertices = c.chance(0.5),
                                 .drop_degenerate = c.chance(0.7),
                                 .drop_duplicates = c.chance(0.5),
                                 .orient = c.chance(0.6),
                                 .split_nonmanifold = c.chance(0.5),
                                 .fill_holes = c.chance(0.5) ? c.below(20) : 0};
    repaired_mesh r;
    if (!refused([&] { r = repair_mesh(m, options); })) {
        require(r.vertex_of.size() == r.mesh.vertex_count() && r.face_of.size() == r.mesh.face_count(), "maps have an entry each");
        for (std::uint32_t const v : r.vertex_of) require(v < m.vertex_count(), "vertices come from the input");
        for (std::uint32_t const f : r.face_of) require(f == repaired_mesh::none || f < m.face_count(), "faces come from the input");
        for (std::uint32_t const v : r.mesh.corners) require(v < r.mesh.vertex_count(), "corners are vertices");
        if (r.report.nothing_done()) require(r.mesh.corners == m.corners && r.mesh.offsets == m.offsets, "nothing done, nothing changed");
        // Twice changes nothing more; what was even refused stays so.
        repaired_mesh const again = repair_mesh(r.mesh, options);
        // Copies of split vertices stand at one place: merged and split again they have other numbers.
        bool same = again.mesh.offsets == r.mesh.offsets;
        for (std::size_t k = 0; same && k < r.mesh.corners.size(); ++k) {
            vec3 const& p = r.mesh.positions[r.mesh.corners[k]];
            vec3 const& q = again.mesh.positions[again.mesh.corners[k]];
            same = p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
        }
        if (!options.merge_vertices) same = same && again.mesh.corners == r.mesh.corners;
        // Filled holes and split edges may lay open what a second pass mends.
        bool const settles = options.fill_holes == 0 && !options.split_nonmanifold;
        require(same || !settles, "repairing twice changes nothing more");
        if (!refused([&] { s = make_solid(r.mesh); })) check_solid(r.mesh, s);
    }
    require(m.corners == copy.corners && m.offsets == copy.offsets, "inputs are not touched");
    // Whatever passed as a solid can be cut, and the volumes add up; surfaces that cut themselves included.
    if (!broken && m.face_count() < 200) {
        s = make_solid(m);
        shard_complex const shards = voronoi_shards(s, std::vector<vec3>{s.bounds.centre(), s.bounds.lo, s.positions[s.triangles[0][0]]},
                                                    {.duplicates = duplicate_sites::merge});
        double total = 0;
        for (double const v : shards.volumes) total += v;
        double const thinness = s.area * s.bounds.diagonal() / s.volume;
        require(std::fabs(total - s.volume) <= std::max(1e-9, 1e-14 * thinness) * s.volume, "law 1: volumes add up");
    }
    return 0;
}
