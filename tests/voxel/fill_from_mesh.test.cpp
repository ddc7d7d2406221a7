#include <catch2/catch.hpp>

#include "fill_testing.hpp"

#include <io/file_testing.hpp>
#include <support/shapes.hpp>
#include <support/test_data.hpp>

#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/voxel/fill_from_mesh.hpp>
#include <tafoni/voxel/fill_from_solid.hpp>
#include <tafoni/voxel/frame_for.hpp>

#include <bit>
#include <cmath>
#include <numbers>

using namespace tafoni;
using tafoni_test::differences;
using tafoni_test::plain_grid;

namespace {

constexpr up_axis all_ups[] = {up_axis::plus_z, up_axis::plus_x, up_axis::plus_y,
                               up_axis::minus_z, up_axis::minus_x, up_axis::minus_y};

/// The definition: solid angles of the open mesh's own triangles, by libm, over 4 pi.
double generalised_winding(indexed_mesh const& m, vec3 const& p) {
    double sum = 0;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const t = m.face(f);
        for (std::size_t k = 2; k < t.size(); ++k) {
            vec3 const a = m.positions[t[0]] - p;
            vec3 const b = m.positions[t[k - 1]] - p;
            vec3 const c = m.positions[t[k]] - p;
            double const la = a.norm();
            double const lb = b.norm();
            double const lc = c.norm();
            sum += 2 * std::atan2(tafoni::dot(a, tafoni::cross(b, c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
        }
    }
    return sum / (4 * std::numbers::pi);
}

/// Leaves out the triangles whose middle `keep` refuses.
template <class Keep>
indexed_mesh pierced(indexed_mesh const& m, Keep const& keep) {
    indexed_mesh r;
    r.positions = m.positions;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        vec3 middle{0, 0, 0};
        for (std::uint32_t const v : m.face(f)) middle += vec3(m.positions[v] / static_cast<double>(m.face(f).size()));
        if (keep(middle)) r.add_face(m.face(f));
    }
    return r;
}

/// Whether p lies on a face, not on a lid: the number jumps there. For flat faces; also beside narrow ones.
bool on_surface(indexed_mesh const& m, vec3 const& p) {
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const t = m.face(f);
        box3 b;
        for (std::uint32_t const v : t) b.include(m.positions[v]);
        vec3 const normal = tafoni::normalized(tafoni::cross(m.positions[t[1]] - m.positions[t[0]], m.positions[t[2]] - m.positions[t[0]]));
        bool inside = std::fabs(normal.dot(p - m.positions[t[0]])) < 1e-6;
        for (int d = 0; d < 3; ++d) inside = inside && p[d] > b.lo[d] - 1e-6 && p[d] < b.hi[d] + 1e-6;
        if (inside) return true;
    }
    return false;
}

template <class Grid>
std::size_t wrong_voxels(Grid const& grid, indexed_mesh const& m, double unsure = 1e-6) {
    auto const n = grid_access<Grid>::size(grid);
    grid_frame const frame{.size = n, .spacing = grid_access<Grid>::spacing(grid), .origin = grid_access<Grid>::origin(grid)};
    std::size_t wrong = 0;
    for (std::size_t k = 0; k < n[2]; ++k) {
        for (std::size_t j = 0; j < n[1]; ++j) {
            for (std::size_t i = 0; i < n[0]; ++i) {
                vec3 const p = frame.centre({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), static_cast<std::int32_t>(k)});
                double const w = generalised_winding(m, p);
                if (std::fabs(w - 0.5) < unsure) continue;
                bool const rock = grid_access<Grid>::state(grid, i, j, k) == voxel_state::rock;
                if ((w > 0.5) != rock && !on_surface(m, p)) ++wrong;
            }
        }
    }
    return wrong;
}

box3 box_of(indexed_mesh const& m) {
    box3 b;
    for (vec3 const& p : m.positions) b.include(p);
    return b;
}

}  // namespace

TEST_CASE("a closed mesh fills as the solid that it bounds") {
    stream random(11, stage::user, 0);
    for (auto const& shape : {tafoni_test::box_with_cavity(), tafoni_test::torus(1.5, 0.5, 20, 10), tafoni_test::l_shape()}) {
        indexed_mesh const mesh = tafoni_test::turned(shape, random);
        sparse_grid grid(frame_for(box_of(mesh), 40));
        auto const report = fill_from_mesh(grid, mesh);
        sparse_grid expected(frame_for(box_of(mesh), 40));
        REQUIRE(fill_from_solid(expected, make_solid(mesh)) == report.rock);
        REQUIRE(differences(grid, expected) == 0);
        REQUIRE((report.holes == 0 && report.boundary_edges == 0 && report.isolated_vertices == 0 && report.dropped_faces == 0));
        REQUIRE(report.volume == Approx(tafoni_test::signed_volume(mesh)));
    }
}

TEST_CASE("with one to three holes the voxels are those whose generalised winding number is a half, for every up") {
    stream random(12, stage::user, 0);
    for (int const holes : {1, 2, 3}) {
        vec3 const a = random.unit_vector();
        vec3 const b = random.unit_vector();
        vec3 const c = random.unit_vector();
        indexed_mesh const mesh = pierced(tafoni_test::icosphere(2), [&](vec3 const& p) {
            return p.dot(a) < 0.9 && (holes < 2 || p.dot(b) < 0.93) && (holes < 3 || p.dot(c) < 0.8);
        });
        grid_frame const frame = frame_for(box_of(mesh), 23);
        plain_grid dense(frame);
        auto const report = fill_from_mesh(dense, mesh);
        REQUIRE(report.holes >= 1);
        REQUIRE(report.boundary_edges >= 3);
        REQUIRE(wrong_voxels(dense, mesh) == 0);
        for (up_axis const up : all_ups) {
            sparse_grid sparse(frame, up);
            REQUIRE(fill_from_mesh(sparse, mesh).rock == report.rock);
            REQUIRE(differences(sparse, dense) == 0);
        }
    }
}

TEST_CASE("a sphere with three holes gives the sphere within a voxel of the lids") {
    indexed_mesh const whole = tafoni_test::icosphere(4);
    std::array<vec3, 3> const at{vec3{1, 0, 0}, vec3{0, -0.6, 0.8}, vec3{-0.48, 0.6, 0.64}};
    indexed_mesh const mesh = pierced(whole, [&](vec3 const& p) {
        return std::all_of(at.begin(), at.end(), [&](vec3 const& h) { return p.dot(h) < 0.985; });
    });
    grid_frame const frame = frame_for(box_of(whole), 48);
    sparse_grid grid(frame);
    REQUIRE(fill_from_mesh(grid, mesh).holes == 3);
    double const edge = frame.spacing[0];
    for (std::int32_t z = 0; z < 50; ++z) {
        for (std::int32_t y = 0; y < 50; ++y) {
            for (std::int32_t x = 0; x < 50; ++x) {
                double const r = frame.centre({x, y, z}).norm();
                if (r > 1 + edge) REQUIRE_FALSE(grid.is_solid({x, y, z}));
                if (r < 0.985 - edge) REQUIRE(grid.is_solid({x, y, z}));
            }
        }
    }
}

TEST_CASE("lids through the centres of voxels are counted on the side that rows see, straight, bent and along the diagonal") {
    indexed_mesh const box = tafoni_test::box({0.5, 0.5, 0.5}, {8.5, 8.5, 8.5});
    for (bool const diagonal : {false, true}) {
        for (unsigned left_out = 1; left_out < 63; ++left_out) {
            if (std::popcount(left_out) > 3) continue;
            indexed_mesh mesh;
            for (vec3 const& p : box.positions) {
                mesh.add_vertex(diagonal ? vec3{0.5 * (p[0] - p[1]) + 9, 0.5 * (p[0] + p[1]), p[2]} : p);
            }
            for (std::size_t f = 0; f < 6; ++f) {
                if ((left_out >> f & 1U) == 0) mesh.add_face(box.face(f));
            }
            grid_frame const frame{.size = {14, 10, 10}};
            plain_grid dense(frame);
            fill_from_mesh(dense, mesh);
            INFO("without the faces " << left_out);
            REQUIRE(wrong_voxels(dense, mesh) == 0);
            for (up_axis const up : {up_axis::plus_x, up_axis::minus_y}) {
                sparse_grid sparse(frame, up);
                fill_from_mesh(sparse, mesh);
                REQUIRE(wrong_voxels(sparse, mesh) == 0);
            }
        }
    }
}

TEST_CASE("a sphere with hundreds of holes is its definition as well, small and wide ones side by side") {
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
        stream random(seed, stage::user, 7);
        double const share = seed == 0 ? 0.1 : 0.02;
        indexed_mesh const mesh = pierced(tafoni_test::icosphere(3), [&](vec3 const& p) {
            double const draw = random.uniform01();
            return draw > share && !(seed == 1 && p[2] > 0.6);
        });
        sparse_grid grid({.size = {18, 17, 19}, .spacing = vec3{0.13, 0.14, 0.12}, .origin = vec3{-1.171, -1.183, -1.127}});
        CAPTURE(seed);
        auto const report = fill_from_mesh(grid, mesh);
        REQUIRE(report.holes > 10);
        REQUIRE(wrong_voxels(grid, mesh) == 0);
    }
}

TEST_CASE("half a sphere, whose lid passes far from its edges, is its definition too") {
    indexed_mesh const mesh = pierced(tafoni_test::icosphere(1), [](vec3 const& p) { return p[0] + 0.3 * p[1] + 0.1 * p[2] < 0.1; });
    plain_grid grid(frame_for(box_of(mesh), 41));
    REQUIRE(fill_from_mesh(grid, mesh).holes == 1);
    REQUIRE(wrong_voxels(grid, mesh) == 0);
}

TEST_CASE("voxels need not be cubes where holes are closed") {
    stream random(13, stage::user, 0);
    indexed_mesh const mesh = pierced(tafoni_test::turned(tafoni_test::torus(1.5, 0.6, 16, 8), random),
                                      [](vec3 const& p) { return p[0] < 1.2; });
    box3 const b = box_of(mesh);
    plain_grid grid({.size = {9, 30, 14},
                     .spacing = vec3(b.extent()[0] / 8, b.extent()[1] / 29, b.extent()[2] / 13),
                     .origin = vec3(b.lo - vec3(0.01 * b.extent()))});
    fill_from_mesh(grid, mesh);
    REQUIRE(wrong_voxels(grid, mesh) == 0);
}

TEST_CASE("seams, doubled faces, isolated vertices and edges of many faces are no holes that matter") {
    indexed_mesh const whole = tafoni_test::fan_triangulated(tafoni_test::box({1, 1, 1}, {5, 6, 7}));
    sparse_grid expected({.size = {8, 8, 8}});
    REQUIRE(fill_from_mesh(expected, whole).rock == 4 * 5 * 6);

    // Every triangle with corners of its own, -0 and 0 alike, and vertices that nothing uses.
    indexed_mesh soup;
    soup.add_vertex({100, 100, 100});
    for (std::size_t f = 0; f < whole.face_count(); ++f) {
        for (std::uint32_t const v : whole.face(f)) soup.add_vertex(whole.positions[v]);
        auto const n = static_cast<std::uint32_t>(soup.positions.size());
        soup.add_face({n - 3, n - 2, n - 1});
    }
    sparse_grid grid({.size = {8, 8, 8}});
    auto report = fill_from_mesh(grid, soup);
    REQUIRE((report.holes == 0 && report.isolated_vertices == 1));
    REQUIRE(differences(grid, expected) == 0);

    // A face twice, and a fin that stands on an edge: the number differs from that of the box by their solid angles.
    indexed_mesh fin = whole;
    fin.add_face({whole.face(3)[0], whole.face(3)[1], whole.face(3)[2]});
    std::uint32_t const tip = static_cast<std::uint32_t>(fin.positions.size());
    fin.add_vertex({3.1, 3.2, 7.9});
    fin.add_face({whole.face(0)[0], whole.face(0)[1], tip});
    fin.add_face({0, 0, 1});
    report = fill_from_mesh(grid, fin);
    REQUIRE(report.boundary_edges == 6);
    REQUIRE(report.dropped_faces == 1);
    REQUIRE(wrong_voxels(grid, fin) == 0);
}

TEST_CASE("a mesh of nothing, or a sheet that encloses nothing, leaves air") {
    sparse_grid grid({.size = {4, 4, 4}});
    grid.set({1, 1, 1}, voxel_state::colluvium);
    REQUIRE(fill_from_mesh(grid, indexed_mesh{}).rock == 0);
    REQUIRE(grid.count(voxel_plane::solid) == 0);
    indexed_mesh sheet;
    sheet.positions = {{0.2, 0.3, 2.2}, {3.7, 0.4, 2.2}, {1.5, 3.6, 2.2}};
    sheet.add_face({0, 1, 2});
    auto const report = fill_from_mesh(grid, sheet);
    REQUIRE((report.rock == 0 && report.holes == 1 && report.boundary_edges == 3 && report.volume == 0));
}

TEST_CASE("meshes that cannot be filled are refused by name, and the grid is as it was") {
    sparse_grid grid({.size = {4, 4, 4}});
    grid.set({1, 1, 1}, voxel_state::colluvium);
    auto const code_of = [&](indexed_mesh const& m) {
        auto const f = tafoni_test::failure_of([&] { return fill_from_mesh(grid, m); });
        REQUIRE(f.happened);
        REQUIRE(grid.count(voxel_plane::colluvium) == 1);
        return f.code;
    };
    indexed_mesh const box = tafoni_test::unit_box();
    for (double const wrong : {static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
        indexed_mesh m = box;
        m.positions[3][1] = wrong;
        REQUIRE(code_of(m) == errc::non_finite_vertex);
    }
    indexed_mesh m = box;
    m.corners[5] = 8;
    REQUIRE(code_of(m) == errc::index_out_of_range);
    m = box;
    m.add_face({0, 1});
    REQUIRE(code_of(m) == errc::degenerate_face);
    m = box;
    m.positions[0] = vec3{-1e30, 0, 0};
    REQUIRE(code_of(m) == errc::out_of_range);
    REQUIRE_THROWS_AS(fill_from_mesh(grid, tafoni_test::inside_out(box)), bad_topology);
    REQUIRE_THROWS_AS(fill_from_mesh(grid, tafoni_test::inside_out(pierced(tafoni_test::icosphere(1), [](vec3 const& p) { return p[2] < 0.7; }))), bad_topology);
    REQUIRE(grid.count(voxel_plane::colluvium) == 1);
}

TEST_CASE("meshes of any scale fill alike") {
    indexed_mesh const mesh = pierced(tafoni_test::icosphere(2), [](vec3 const& p) { return p[2] < 0.8; });
    sparse_grid expected(frame_for(box_of(mesh), 20));
    auto const rock = fill_from_mesh(expected, mesh).rock;
    for (double const scale : {0x1p-90, 0x1p-30, 0x1p40, 0x1p90}) {
        indexed_mesh scaled = mesh;
        for (vec3& p : scaled.positions) p = vec3(scale * p);
        sparse_grid grid(frame_for(box_of(scaled), 20));
        REQUIRE(fill_from_mesh(grid, scaled).rock == rock);
        REQUIRE(differences(grid, expected) == 0);
    }
}

TEST_CASE("a hand that is open at the wrist is filled up to its lid") {
    auto const path = tafoni_test::find("meshes/hand_lowres.obj");
    if (path.empty()) {
        WARN("skipped: no data");
        return;
    }
    indexed_mesh const mesh = read_mesh(path).mesh;
    sparse_grid grid(frame_for(box_of(mesh), 128));
    auto const report = fill_from_mesh(grid, mesh);
    REQUIRE((report.holes == 1 && report.boundary_edges == 16));
    double const edge = grid.spacing()[0];
    REQUIRE(static_cast<double>(report.rock) * edge * edge * edge == Approx(report.volume).epsilon(0.005));
}
