#include <tafoni/geometry/terrain_solid.hpp>

#include <tafoni/core/random.hpp>

#include <catch2/catch.hpp>

#include <support/test_data.hpp>

#include <fstream>
#include <map>
#include <string>

using namespace tafoni;

namespace {

height_grid flat(std::size_t columns, std::size_t rows, double height) {
    height_grid g;
    g.columns = columns;
    g.rows = rows;
    g.heights.assign(columns * rows, height);
    return g;
}

height_grid rough(std::size_t columns, std::size_t rows, std::uint64_t seed, double missing) {
    height_grid g = flat(columns, rows, 0);
    g.cell_size_x = 2;
    g.cell_size_y = 3;
    g.missing.assign(columns * rows, 0);
    stream draw(seed, stage::user, 0);
    for (std::size_t i = 0; i < g.heights.size(); ++i) {
        g.heights[i] = draw.uniform(100, 110);
        g.missing[i] = draw.chance(missing) ? 1 : 0;
    }
    return g;
}

/// Law 53, from the solid's own top triangles and the plain formula for areas in the plane.
double column_volume(solid const& s) {
    double base = s.positions[s.triangles[0][0]][2];
    for (auto const& p : s.positions) base = std::min(base, p[2]);
    return pairwise_sum(0, s.triangles.size(), [&](std::size_t t) {
        if (s.artificial[s.polygon_of[t]] != 0) return 0.0;
        vec3 const& a = s.positions[s.triangles[t][0]];
        vec3 const& b = s.positions[s.triangles[t][1]];
        vec3 const& c = s.positions[s.triangles[t][2]];
        double const plan = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        return plan * ((a[2] - base) + (b[2] - base) + (c[2] - base)) / 3;
    });
}

/// Every vertex that is used has exactly one fan of triangles around it.
bool is_manifold_at_vertices(solid const& s) {
    std::vector<std::size_t> corners(s.positions.size(), 0);
    std::vector<std::uint32_t> any(s.positions.size(), 0);
    for (std::uint32_t h = 0; h < 3 * s.triangles.size(); ++h) {
        std::uint32_t const v = s.triangles[h / 3][h % 3];
        ++corners[v];
        any[v] = h;
    }
    for (std::size_t v = 0; v < corners.size(); ++v) {
        if (corners[v] == 0) continue;
        std::size_t around = 0;
        std::uint32_t h = any[v];
        do {
            ++around;
            std::uint32_t const before = h % 3 == 0 ? h + 2 : h - 1;
            h = s.opposite[before];
        } while (h != any[v] && around <= corners[v]);
        if (around != corners[v]) return false;
    }
    return true;
}

height_grid read_plain_asc(std::filesystem::path const& path) {
    std::ifstream in(path);
    std::map<std::string, double> header;
    height_grid g;
    for (int i = 0; i < 6; ++i) {
        std::string key;
        double value = 0;
        in >> key >> value;
        header[key] = value;
    }
    g.columns = static_cast<std::size_t>(header["ncols"]);
    g.rows = static_cast<std::size_t>(header["nrows"]);
    g.cell_size_x = g.cell_size_y = header["cellsize"];
    g.lower_left_x = header["xllcorner"];
    g.lower_left_y = header["yllcorner"];
    double h = 0;
    while (in >> h) {
        g.heights.push_back(h);
        g.missing.push_back(h == header["NODATA_value"] ? 1 : 0);
    }
    return g;
}

}  // namespace

TEST_CASE("a flat terrain is a box whose sides and base are artificial") {
    solid const s = terrain_solid(flat(5, 4, 7), {.depth = 2});
    CHECK(s.volume == Approx(4.0 * 3 * 2).epsilon(1e-14));
    CHECK(s.area == Approx(2 * 12 + 2 * 14).epsilon(1e-14));
    CHECK(s.bounds.lo == vec3(0.5, 0.5, 5));
    CHECK(s.bounds.hi == vec3(4.5, 3.5, 7));
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        bool top = true;
        for (auto const v : s.triangles[t]) top = top && s.positions[v][2] == 7;
        CHECK((s.artificial[s.polygon_of[t]] == 0) == top);
    }
}

TEST_CASE("law 53: the volume of a terrain is the sum of mean height above base times plan area") {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        double const missing = seed % 4 == 0 ? 0.0 : 0.1 * static_cast<double>(seed % 7);
        height_grid const g = rough(3 + seed % 9, 3 + seed % 5, seed, missing);
        try {
            solid const s = terrain_solid(g, {.depth = seed % 2 == 0 ? 0.0 : 0.5});
            CAPTURE(seed);
            CHECK(std::fabs(s.volume / column_volume(s) - 1) < 1e-12);
            CHECK(is_manifold_at_vertices(s));
        } catch (invalid_input const& e) {
            CHECK(e.code() == errc::empty_input);
            CHECK(missing > 0);
        }
    }
}

TEST_CASE("missing nodes leave holes, and pieces that touch in a node get a vertex each") {
    // Two blocks of nodes that meet in the middle node only.
    height_grid g = flat(5, 5, 1);
    g.missing.assign(25, 0);
    for (std::size_t r = 0; r < 5; ++r) {
        for (std::size_t c = 0; c < 5; ++c) {
            bool const north_west = r <= 2 && c <= 2;
            bool const south_east = r >= 2 && c >= 2;
            g.missing[r * 5 + c] = north_west || south_east ? 0 : 1;
        }
    }
    solid const s = terrain_solid(g, {.depth = 1});
    // The quads beside the middle have three heights each and lend it a triangle: the pieces are joined there.
    CHECK(s.volume == Approx(9).epsilon(1e-14));
    CHECK(is_manifold_at_vertices(s));

    // Without two of their nodes nothing but the middle is shared.
    g.missing[2 * 5 + 1] = g.missing[2 * 5 + 3] = 1;
    solid const apart = terrain_solid(g, {.depth = 1});
    std::size_t middles = 0;
    for (auto const& p : apart.positions) middles += p == vec3(2.5, 2.5, 1) ? 1U : 0U;
    CHECK(middles == 2);
    CHECK(is_manifold_at_vertices(apart));

    height_grid ring = flat(3, 3, 1);
    ring.missing.assign(9, 0);
    ring.missing[4] = 1;
    solid const frame = terrain_solid(ring, {.depth = 1});
    CHECK(frame.volume == Approx(2).epsilon(1e-14));
    CHECK(is_manifold_at_vertices(frame));
}

TEST_CASE("the diagonal joins the corners of nearer height, from south-west to north-east on a tie") {
    auto const has_edge = [](solid const& s, vec3 const& a, vec3 const& b) {
        for (auto const& t : s.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                if (s.positions[t[k]] == a && s.positions[t[(k + 1) % 3]] == b) return true;
            }
        }
        return false;
    };
    height_grid g = flat(2, 2, 0);
    CHECK(has_edge(terrain_solid(g), vec3(0.5, 0.5, 0), vec3(1.5, 1.5, 0)));
    g.heights = {0, 5, 1, 0};  // north-west, north-east, south-west, south-east
    CHECK(has_edge(terrain_solid(g), vec3(0.5, 1.5, 0), vec3(1.5, 0.5, 0)));
}

TEST_CASE("centre registration puts the first node on the given point") {
    height_grid g = flat(2, 2, 0);
    g.lower_left_x = 100;
    g.registration = grid_registration::centre;
    CHECK(terrain_solid(g).bounds.lo[0] == 100);
    g.registration = grid_registration::corner;
    CHECK(terrain_solid(g).bounds.lo[0] == 100.5);
}

TEST_CASE("a bad height grid is refused by name") {
    auto const code = [](height_grid const& g, terrain_options const& o = {}) {
        try {
            (void)terrain_solid(g, o);
        } catch (invalid_input const& e) {
            return e.code();
        }
        return errc{};
    };
    double const nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(code(flat(2, 2, 1)) == errc{});
    CHECK(code(height_grid{}) == errc::empty_input);
    CHECK(code(flat(1, 9, 1)) == errc::empty_input);
    height_grid g = flat(3, 3, 1);
    g.heights.pop_back();
    CHECK(code(g) == errc::attribute_length);
    g = flat(3, 3, 1);
    g.missing.assign(8, 0);
    CHECK(code(g) == errc::attribute_length);
    g.missing.assign(9, 1);
    CHECK(code(g) == errc::empty_input);
    g = flat(3, 3, 1);
    g.heights[4] = nan;
    CHECK(code(g) == errc::non_finite_vertex);
    g.missing.assign(9, 0);
    g.missing[4] = 1;
    CHECK(code(g) == errc{});
    for (double const bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        g = flat(3, 3, 1);
        g.cell_size_x = bad;
        CHECK(code(g) == errc::bad_parameter);
        g = flat(3, 3, 1);
        g.cell_size_y = bad;
        CHECK(code(g) == errc::bad_parameter);
    }
    CHECK(code(flat(3, 3, 1), {.depth = -1}) == errc::bad_parameter);
    CHECK(code(flat(3, 3, 1), {.depth = nan}) == errc::bad_parameter);
    g = flat(2, 2, 1);
    g.columns = g.rows = std::size_t{1} << 63;
    CHECK(code(g) == errc::size_overflow);
}

TEST_CASE("real terrain becomes a solid, missing cells left out") {
    for (char const* name : {"dems/sthelens_slope_10m.asc", "dems/stubai_10m.asc"}) {
        auto const path = tafoni_test::find(name);
        if (path.empty()) {
            WARN("skipped: no data");
            return;
        }
        height_grid const g = read_plain_asc(path);
        solid const s = terrain_solid(g);
        CAPTURE(name);
        CHECK(std::fabs(s.volume / column_volume(s) - 1) < 1e-12);
        CHECK(is_manifold_at_vertices(s));
        std::size_t gone = 0;
        for (auto const m : g.missing) gone += m;
        if (std::string(name).find("sthelens") != std::string::npos) CHECK(gone == 122);
    }
}
