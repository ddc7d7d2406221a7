#include <tafoni/decomposition/voronoi_shards.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/decomposition/locate.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "support/shapes.hpp"
#include "support/shard_laws.hpp"

using namespace tafoni;
using tafoni_test::broken_laws;

namespace {

std::vector<vec3> uniform_points(box3 const& box, std::size_t n, std::uint64_t seed = 1) {
    std::vector<vec3> points;
    stream draw(seed, stage::user, 0);
    for (std::size_t k = 0; k < n; ++k) {
        vec3 p{0, 0, 0};
        for (int a = 0; a < 3; ++a) p[a] = draw.uniform(box.lo[a], box.hi[a]);
        points.push_back(p);
    }
    return points;
}

/// Cell centres of an n^3 grid, moved by up to `jitter` of the box along each axis.
std::vector<vec3> grid_points(box3 const& box, int n, double jitter = 0) {
    std::vector<vec3> points;
    stream draw(2, stage::user, 0);
    vec3 const size = box.extent();
    for (int k = 0; k < n * n * n; ++k) {
        std::array<int, 3> const q{k % n, k / n % n, k / n / n};
        vec3 p{0, 0, 0};
        for (int a = 0; a < 3; ++a) {
            double const move = jitter > 0 ? draw.uniform(-jitter, jitter) : 0.0;
            p[a] = box.lo[a] + size[a] * ((q[static_cast<std::size_t>(a)] + 0.5) / n + move);
        }
        points.push_back(p);
    }
    return points;
}

/// The site patterns whose diagrams have many ties, stretched to the box.
std::map<std::string, std::vector<vec3>> hard_patterns(box3 const& box) {
    std::map<std::string, std::vector<vec3>> patterns;
    auto const place = [&box](double x, double y, double z) {
        vec3 const e = box.extent();
        return vec3{box.lo[0] + e[0] * x, box.lo[1] + e[1] * y, box.lo[2] + e[2] * z};
    };
    patterns["uniform"] = uniform_points(box, 150);
    patterns["grid"] = grid_points(box, 4);
    patterns["grid through the middle"] = grid_points(box, 3);
    patterns["grid, jitter 1e-9"] = grid_points(box, 4, 1e-9);
    patterns["grid, jitter 1e-12"] = grid_points(box, 4, 1e-12);
    patterns["grid, jitter 1e-14"] = grid_points(box, 4, 1e-14);
    auto& hex = patterns["hexagonal prisms"];
    for (int x = 0; x < 5; ++x) {
        for (int y = 0; y < 5; ++y) {
            for (int z = 0; z < 2; ++z) hex.push_back(place((x + 0.25 + (y % 2) * 0.5) / 5.5, (y + 0.5) / 5, (z + 0.5) / 2));
        }
    }
    auto& bcc = patterns["body-centred"];
    auto& fcc = patterns["face-centred"];
    for (int k = 0; k < 27; ++k) {
        double const x = (k % 3 + 0.25) / 3;
        double const y = (k / 3 % 3 + 0.25) / 3;
        double const z = (k / 9 + 0.25) / 3;
        double const h = 0.5 / 3;
        bcc.push_back(place(x, y, z));
        bcc.push_back(place(x + h, y + h, z + h));
        fcc.push_back(place(x, y, z));
        fcc.push_back(place(x + h, y + h, z));
        fcc.push_back(place(x + h, y, z + h));
        fcc.push_back(place(x, y + h, z + h));
    }
    auto& ball = patterns["on a sphere, with its centre"];
    ball.push_back(place(0.5, 0.5, 0.5));
    stream draw(5, stage::user, 0);
    for (int k = 0; k < 60; ++k) {
        vec3 const u = draw.unit_vector();
        ball.push_back(place(0.5 + 0.3 * u[0], 0.5 + 0.3 * u[1], 0.5 + 0.3 * u[2]));
    }
    auto& plane = patterns["in a plane"];
    for (int k = 0; k < 60; ++k) {
        double const x = draw.uniform01();
        double const y = draw.uniform01();
        plane.push_back(place(x, y, 0.5));
    }
    auto& crowd = patterns["nine in ten in a hundredth"];
    for (int k = 0; k < 150; ++k) {
        double const scale = k % 10 == 0 ? 1.0 : 0.2;
        double const x = draw.uniform01();
        double const y = draw.uniform01();
        double const z = draw.uniform01();
        crowd.push_back(place(0.1 + 0.8 * scale * x, 0.1 + 0.8 * scale * y, 0.1 + 0.8 * scale * z));
    }
    auto& speck = patterns["a cluster of 1e-13"];
    for (int k = 0; k < 40; ++k) {
        double const x = draw.uniform(-1e-13, 1e-13);
        double const y = draw.uniform(-1e-13, 1e-13);
        speck.push_back(place(0.5 + x, 0.5 + y, 0.5 + draw.uniform(-1e-13, 1e-13)));
    }
    patterns["one site"] = {place(0.3, 0.4, 0.5)};
    return patterns;
}

std::map<std::string, indexed_mesh> shapes() {
    using namespace tafoni_test;
    return {{"box", unit_box()},          {"L", l_shape()},
            {"cavity", box_with_cavity()}, {"two boxes", two_boxes()},
            {"frame", tafoni_test::frame()}, {"torus", torus(2, 0.6, 24, 12)},
            {"limbs", thin_limbs()},      {"relief", relief(12)},
            {"ball", icosphere(2)},       {"terrain", terrain_block(12, 10)}};
}

void require_laws(solid const& body, std::vector<vec3> const& sites, tafoni_test::law_options const& options = {}) {
    auto const c = voronoi_shards(body, sites, {.duplicates = duplicate_sites::merge});
    auto const broken = broken_laws(body, c, options);
    for (auto const& b : broken) UNSCOPED_INFO(b);
    CHECK(broken.empty());
}

/// Twice the area vector inside the outline of face f, holes included.
vec3 doubled_outline(shard_complex const& c, std::uint32_t f) {
    return detail::doubled_area(c.face_loop(face_index{f}, 0), [&c](vertex_index v) { return c.position(v); });
}

std::string bytes_of(shard_complex const& c) {
    std::string s;
    auto const add = [&s](auto const& v) { s.append(reinterpret_cast<char const*>(v.data()), v.size() * sizeof v[0]); };
    add(c.vertices);
    add(c.corners);
    add(c.loop_begin);
    add(c.face_begin);
    add(c.faces);
    add(c.cell_faces);
    add(c.volumes);
    add(c.centroids);
    add(c.site_of);
    return s;
}

}  // namespace

TEST_CASE("every kind of solid keeps the laws of a complex under every kind of sites") {
    for (auto const& [shape, mesh] : shapes()) {
        solid const body = make_solid(mesh);
        for (auto const& [pattern, sites] : hard_patterns(body.bounds)) {
            INFO(shape << ", sites: " << pattern);
            require_laws(body, sites, {.points = 60});
        }
    }
}

TEST_CASE("sites on vertices, edges and faces of the solid break no law") {
    solid const body = make_solid(tafoni_test::l_shape());
    std::vector<vec3> sites = body.positions;
    sites.push_back(vec3{1, 0, 0});
    sites.push_back(vec3{0.5, 0.5, 1});
    sites.push_back(vec3{1, 1, 0.5});
    require_laws(body, sites);
}

TEST_CASE("an L is not cut to the convex part that half-spaces would leave") {
    solid const body = make_solid(tafoni_test::l_shape());
    auto const c = voronoi_shards(body, uniform_points(body.bounds, 500));
    double total = 0;
    for (double v : c.volumes) total += v;
    CHECK(total == Approx(3.0).epsilon(1e-12));
}

TEST_CASE("a lattice of sites cuts a box into equal cells with six neighbours inside") {
    for (int n : {2, 3, 5, 8}) {
        solid const body = make_solid(tafoni_test::unit_box());
        auto const c = voronoi_shards(body, grid_points(body.bounds, n));
        REQUIRE(c.cell_count() == static_cast<std::size_t>(n * n * n));
        double const v = 1.0 / (n * n * n);
        std::size_t large = 0;
        for (std::size_t k = 0; k < c.cell_count(); ++k) CHECK(std::fabs(c.volumes[k] - v) <= 1e-12 * v);
        for (std::uint32_t f = 0; f < c.interior_face_count; ++f) {
            double const area = length(tafoni_test::sum_face(c, f, vec3{0, 0, 0}).area);
            bool const whole = std::fabs(area - 1.0 / (n * n)) < 1e-12;
            CHECK((whole || area < 1e-12));
            large += whole ? 1 : 0;
        }
        CHECK(large == static_cast<std::size_t>(3 * n * n * (n - 1)));
    }
}

TEST_CASE("two boxes and one site make two shards of it, a cavity makes one with a hole") {
    auto const c = voronoi_shards(make_solid(tafoni_test::two_boxes()), std::vector<vec3>{vec3{0.5, 0.5, 0.5}});
    REQUIRE(c.cell_count() == 2);
    CHECK(c.shards_of(site_index{std::uint32_t{0}}).size() == 2);
    CHECK(c.volumes[0] == Approx(1).epsilon(1e-12));
    CHECK(c.volumes[1] == Approx(1).epsilon(1e-12));

    auto const h = voronoi_shards(make_solid(tafoni_test::box_with_cavity()), std::vector<vec3>{vec3{0.1, 0.1, 0.1}});
    REQUIRE(h.cell_count() == 1);
    CHECK(h.volumes[0] == Approx(26).epsilon(1e-12));
    CHECK(h.interior_face_count == 0);
    CHECK(h.merged_slivers == 0);

    // Of two pieces in one cell the cavity belongs to the one around it, not to the larger one.
    auto mesh = tafoni_test::box_with_cavity();
    tafoni_test::append(mesh, tafoni_test::box(vec3{4, 0, 0}, vec3{8, 4, 4}));
    auto const two = voronoi_shards(make_solid(mesh), std::vector<vec3>{vec3{0.1, 0.1, 0.1}});
    REQUIRE(two.cell_count() == 2);
    CHECK(std::min(two.volumes[0], two.volumes[1]) == Approx(26).epsilon(1e-12));
    CHECK(std::max(two.volumes[0], two.volumes[1]) == Approx(64).epsilon(1e-12));
}

TEST_CASE("of hollow balls in one cell each keeps its own cavity, however many there are") {
    indexed_mesh mesh;
    for (int k = 0; k < 30; ++k) {
        double const x = 8.0 * (k % 5);
        double const y = 8.0 * (k / 5);
        auto hollow = tafoni_test::box_with_cavity();
        for (vec3& p : hollow.positions) p = vec3{p[0] * (1 + 0.01 * k) + x, p[1] * (1 + 0.01 * k) + y, p[2] * (1 + 0.01 * k)};
        tafoni_test::append(mesh, hollow);
    }
    auto const c = voronoi_shards(make_solid(mesh), std::vector<vec3>{vec3{16, 16, 1}});
    REQUIRE(c.cell_count() == 30);
    std::vector<double> volumes(c.volumes);
    std::sort(volumes.begin(), volumes.end());
    for (std::size_t k = 0; k < volumes.size(); ++k) {
        double const edge = 1 + 0.01 * static_cast<double>(k);
        CHECK(volumes[k] == Approx(26 * edge * edge * edge).epsilon(1e-12));
    }
}

TEST_CASE("a cut through many tubes gives a ring for each of them") {
    indexed_mesh mesh;
    for (int k = 0; k < 40; ++k) {
        auto tube = tafoni_test::frame();
        double const s = 1 + 0.01 * k;
        for (vec3& p : tube.positions) p = vec3{s * p[0] + 5.0 * (k % 8), s * p[1] + 5.0 * (k / 8), p[2]};
        tafoni_test::append(mesh, tube);
    }
    auto const c = voronoi_shards(make_solid(mesh), std::vector<vec3>{vec3{20, 12, 0.25}, vec3{20, 12, 0.75}});
    REQUIRE(c.interior_face_count == 40);
    for (std::uint32_t f = 0; f < 40; ++f) {
        CHECK(c.loop_count(face_index{f}) == 2);
        double const outline = length(doubled_outline(c, f));
        CHECK(2 * length(tafoni_test::sum_face(c, f, vec3{0, 0, 0}).area) == Approx(outline * 8 / 9).epsilon(1e-9));
    }
}

TEST_CASE("a face around a bore keeps it as a hole loop") {
    // The bisector x = 1.5 of these sites would miss the bore; z = 0.5 cuts it all around.
    std::vector<vec3> const sites{vec3{1.5, 1.5, 0.25}, vec3{1.5, 1.5, 0.75}};
    auto const c = voronoi_shards(make_solid(tafoni_test::frame()), sites);
    REQUIRE(c.cell_count() == 2);
    REQUIRE(c.interior_face_count == 1);
    CHECK(c.loop_count(face_index{std::uint32_t{0}}) == 2);
    CHECK(length(tafoni_test::sum_face(c, 0, vec3{0, 0, 0}).area) == Approx(8).epsilon(1e-12));
    CHECK(c.volumes[0] == Approx(4).epsilon(1e-12));
}

TEST_CASE("a ring that a cell wraps around twice gives a shard with a handle") {
    auto const c = voronoi_shards(make_solid(tafoni_test::torus(2, 0.6, 24, 12)), std::vector<vec3>{vec3{2, 0, 0}});
    REQUIRE(c.cell_count() == 1);
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::uint32_t f = 0; f < c.face_count(); ++f) {
        auto const loop = c.face_loop(face_index{f}, 0);
        for (std::size_t k = 0; k < loop.size(); ++k) {
            auto const a = loop[k].value;
            auto const b = loop[(k + 1) % loop.size()].value;
            edges.insert({std::min(a, b), std::max(a, b)});
        }
    }
    auto const chi = static_cast<long>(c.vertex_count()) - static_cast<long>(edges.size()) + static_cast<long>(c.face_count());
    CHECK(chi == 0);
}

TEST_CASE("a permutation of the sites permutes ids only") {
    solid const body = make_solid(tafoni_test::torus(2, 0.6, 24, 12));
    auto const sites = uniform_points(body.bounds, 200);
    std::vector<vec3> reversed(sites.rbegin(), sites.rend());
    auto const c = voronoi_shards(body, sites);
    auto const d = voronoi_shards(body, reversed);
    REQUIRE(c.cell_count() == d.cell_count());
    CHECK(c.corners == d.corners);
    CHECK(c.volumes == d.volumes);
    for (std::size_t k = 0; k < c.cell_count(); ++k) CHECK(c.site_of[k].value + d.site_of[k].value == sites.size() - 1);
}

TEST_CASE("moves and powers of two that coordinates can hold commute with the cut") {
    auto mesh = tafoni_test::l_shape();
    auto sites = uniform_points(make_solid(mesh).bounds, 120);
    for (vec3& s : sites) {
        for (int a = 0; a < 3; ++a) s[a] = std::floor(s[a] * 0x1p20) * 0x1p-20;
    }
    auto const c = voronoi_shards(make_solid(mesh), sites);
    for (double scale : {0x1p-90, 1.0, 0x1p60}) {
        double const shift = scale == 1.0 ? 1048576.0 : 0.0;
        auto moved = mesh;
        auto moved_sites = sites;
        for (vec3& p : moved.positions) p = vec3{p[0] * scale + shift, p[1] * scale - shift, p[2] * scale + 3 * shift};
        for (vec3& p : moved_sites) p = vec3{p[0] * scale + shift, p[1] * scale - shift, p[2] * scale + 3 * shift};
        auto const d = voronoi_shards(make_solid(moved), moved_sites);
        CHECK(c.corners == d.corners);
        CHECK(c.site_of == d.site_of);
        REQUIRE(c.volumes.size() == d.volumes.size());
        for (std::size_t k = 0; k < c.volumes.size(); ++k) CHECK(d.volumes[k] == c.volumes[k] * scale * scale * scale);
    }
}

TEST_CASE("the complex has the same bytes for every number of threads", "[threads]") {
    solid const body = make_solid(tafoni_test::relief(30));
    auto const sites = uniform_points(body.bounds, 1500);
    auto const one = bytes_of(voronoi_shards(body, sites));
    for (std::size_t n : {std::size_t{2}, std::size_t{3}, std::size_t{7}}) {
        thread_pool pool(n);
        CHECK(bytes_of(voronoi_shards(body, sites, {}, pool)) == one);
    }
}

TEST_CASE("sites at one place are named, or merged and counted") {
    solid const body = make_solid(tafoni_test::unit_box());
    std::vector<vec3> const sites{vec3{0.25, 0.5, 0.5}, vec3{0.75, 0.5, 0.5}, vec3{0.25, 0.5, 0.5}};
    try {
        (void)voronoi_shards(body, sites);
        FAIL("duplicates were accepted");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::duplicate_sites);
    }
    auto const c = voronoi_shards(body, sites, {.duplicates = duplicate_sites::merge});
    REQUIRE(c.cell_count() == 2);
    CHECK(c.merged_sites == 1);
    REQUIRE(c.shards_of(site_index{std::uint32_t{2}}).size() == 1);
    CHECK(c.shards_of(site_index{std::uint32_t{2}})[0] == c.shards_of(site_index{std::uint32_t{0}})[0]);
    CHECK(c.volumes[0] == 0.5);
    CHECK(broken_laws(body, c).empty());
}

TEST_CASE("sites outside the box are named, or dropped and counted") {
    solid const body = make_solid(tafoni_test::unit_box());
    std::vector<vec3> const sites{vec3{2, 0, 0}, vec3{0.5, 0.5, 0.5}, vec3{0, 0, -1e-12}};
    try {
        (void)voronoi_shards(body, sites);
        FAIL("a site outside was accepted");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::site_outside);
        CHECK(e.place().index == 0);
    }
    auto const c = voronoi_shards(body, sites, {.outside = outside_sites::drop});
    CHECK(c.dropped_sites == 2);
    REQUIRE(c.cell_count() == 1);
    CHECK(c.site_of[0].value == 1);
    CHECK(c.shards_of(site_index{std::uint32_t{0}}).empty());
    auto const codes = [&](std::vector<vec3> const& bad, voronoi_shards_options const& o) {
        try {
            (void)voronoi_shards(body, bad, o);
        } catch (invalid_input const& e) {
            return e.code();
        }
        return errc{};
    };
    double const nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(codes({}, {}) == errc::no_sites);
    CHECK(codes({vec3{5, 5, 5}}, {.outside = outside_sites::drop}) == errc::no_sites);
    CHECK(codes({vec3{0.5, nan, 0.5}}, {}) == errc::non_finite_site);
    CHECK(codes({vec3{0.5, 0.5, 0.5}}, {.patch_angle = nan}) == errc::bad_parameter);
    CHECK(codes({vec3{0.5, 0.5, 0.5}}, {.patch_angle = 181}) == errc::bad_parameter);
    CHECK(codes({vec3{0.5, 0.5, 0.5}}, {.min_volume = -1}) == errc::bad_parameter);
}

TEST_CASE("small shards go to a neighbour, and the volume stays") {
    solid const body = make_solid(tafoni_test::unit_box());
    auto const sites = uniform_points(body.bounds, 300);
    auto const all = voronoi_shards(body, sites);
    auto const some = voronoi_shards(body, sites, {.min_volume = 0.002});
    CHECK(all.merged_slivers == 0);
    CHECK(some.merged_slivers > 10);
    CHECK(some.cell_count() + some.merged_slivers == all.cell_count());
    for (double v : some.volumes) CHECK(v > 0.002);
    auto const broken = broken_laws(body, some);
    for (auto const& b : broken) UNSCOPED_INFO(b);
    CHECK(broken.empty());
    // A site whose cell went to a neighbour names the shard that holds it, so points there are still found.
    shard_locator const before(all);
    shard_locator const after(some);
    for (std::size_t s = 0; s < sites.size(); ++s) {
        auto const shards = some.shards_of(site_index{s});
        REQUIRE(shards.size() == 1);
        CHECK(after(sites[s]) == shards[0]);
        CHECK(after(all.centroids[before(sites[s]).value]) == shards[0]);
    }
    for (std::uint32_t k = 0; k < some.cell_count(); ++k) {
        auto const own = some.shards_of(some.site_of[k]);
        CHECK(std::count(own.begin(), own.end(), cell_index{k}) == 1);
    }
}

TEST_CASE("a limit above every shard leaves one per part of the solid") {
    solid const body = make_solid(tafoni_test::two_boxes());
    auto const sites = uniform_points(body.bounds, 60);
    auto const c = voronoi_shards(body, sites, {.min_volume = 1});
    CHECK(c.cell_count() == 2);
    CHECK(c.interior_face_count == 0);
    auto const broken = broken_laws(body, c);
    for (auto const& b : broken) UNSCOPED_INFO(b);
    CHECK(broken.empty());
    // What a shard took in brings neighbours along, so none stays below the limit.
    solid const ball = make_solid(tafoni_test::icosphere(2));
    for (double least : {0.01, 0.03, 0.1}) {
        for (std::uint64_t seed = 0; seed < 10; ++seed) {
            auto const r = voronoi_shards(ball, uniform_points(ball.bounds, 80, seed), {.min_volume = least});
            for (double v : r.volumes) CHECK(v > least * ball.volume);
        }
    }
}

TEST_CASE("patches follow the angle between polygons") {
    solid body = make_solid(tafoni_test::l_shape());
    std::vector<vec3> const sites{vec3{0.5, 0.5, 0.5}};
    CHECK(voronoi_shards(body, sites).patch_count == 8);
    CHECK(voronoi_shards(body, sites, {.patch_angle = 0}).patch_count == 8);
    CHECK(voronoi_shards(body, sites, {.patch_angle = 89.999}).patch_count == 8);
    CHECK(voronoi_shards(body, sites, {.patch_angle = 90}).patch_count == 1);

    solid const ball = make_solid(tafoni_test::icosphere(3));
    CHECK(voronoi_shards(ball, sites, {.outside = outside_sites::drop}).patch_count == 1);
    auto const fine = voronoi_shards(ball, sites, {.patch_angle = 0});
    CHECK(fine.patch_count == ball.polygon_count);

    body.artificial.assign(body.polygon_count, 0);
    body.artificial[0] = 1;
    auto const c = voronoi_shards(body, sites);
    CHECK(c.patch_count == 7);
    for (std::size_t f = c.interior_face_count; f < c.face_count(); ++f) {
        bool const base = c.polygon_of[c.face_source(face_index{f})] == 0;
        CHECK(c.face_patch(face_index{f}).valid() == !base);
    }
}

TEST_CASE("skin faces lie in the triangle that they name as their source") {
    solid const body = make_solid(tafoni_test::torus(2, 0.6, 24, 12));
    auto const c = voronoi_shards(body, uniform_points(body.bounds, 100));
    for (std::size_t f = c.interior_face_count; f < c.face_count(); ++f) {
        auto const& t = body.triangles[c.face_source(face_index{f})];
        vec3 const n = normalized(cross(vec3(body.positions[t[1]] - body.positions[t[0]]), vec3(body.positions[t[2]] - body.positions[t[0]])));
        for (vertex_index v : c.face_loop(face_index{f}, 0)) {
            CHECK(std::fabs(dot(n, vec3(c.position(v) - body.positions[t[0]]))) < 1e-12);
        }
    }
}

TEST_CASE("a cut can be cancelled at every tick") {
    solid const body = make_solid(tafoni_test::unit_box());
    auto const sites = uniform_points(body.bounds, 20);
    int ticks = 0;
    run_context context;
    context.on_progress = [&](progress_event const&) {
        ++ticks;
        return step_control::proceed;
    };
    auto const whole = bytes_of(voronoi_shards(body, sites, {}, inline_executor{}, context));
    REQUIRE(ticks > 5);
    for (int stop = 1; stop <= ticks; ++stop) {
        int seen = 0;
        context.on_progress = [&](progress_event const&) { return ++seen == stop ? step_control::stop : step_control::proceed; };
        CHECK_THROWS_AS(voronoi_shards(body, sites, {}, inline_executor{}, context), cancelled);
    }
    CHECK(bytes_of(voronoi_shards(body, sites)) == whole);
}
