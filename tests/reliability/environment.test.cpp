#include "reliability/cases.hpp"

#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/io/obj.hpp>
#include <tafoni/io/ply.hpp>
#include <tafoni/testing/structure_laws.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

#include <cfenv>
#include <clocale>
#include <locale>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// Cuts, links and weathers random models; the laws that are broken, topology above all.
std::vector<std::string> broken_models(std::uint64_t from, std::uint64_t to) {
    std::vector<std::string> all;
    for (std::uint64_t seed = from; seed < to; ++seed) {
        choices c(seed);
        random_body const body = make_random_body(c);
        try {
            solid const s = make_solid(body.mesh);
            std::string name;
            std::vector<vec3> const sites = make_random_sites(s, c, name);
            shard_complex const shards = voronoi_shards(s, sites, {.duplicates = duplicate_sites::merge});
            for (std::string const& law : broken_laws(s, shards, laws_for(body, s, 0))) all.push_back(std::to_string(seed) + ": " + law);
            link_graph const g = make_link_graph(shards);
            for (std::string const& law : laws::network(g)) all.push_back(std::to_string(seed) + ": " + law);
            frost_run run(g, {}, {.seed = seed});
            frost_report const r = run.run({.paths = 50, .batch = 5});
            if (!(std::fabs(r.water_in - r.water_absorbed - r.water_lost - r.water_drained) <= 1e-12 * r.water_in)) {
                all.push_back(std::to_string(seed) + ": the ledger of water does not close");
            }
        } catch (std::exception const& e) {
            all.push_back(std::to_string(seed) + ": " + e.what());
        }
    }
    return all;
}

std::string first_of(std::vector<std::string> const& all) { return all.empty() ? std::string() : all.front(); }

}  // namespace

TEST_CASE("C6: under any rounding mode results may differ in their last bits, but stay whole") {
    for (int const mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        std::fesetround(mode);
        auto const broken = broken_models(0, 150);
        std::fesetround(FE_TONEAREST);
        INFO("rounding mode " << mode << ": " << first_of(broken));
        CHECK(broken.empty());
    }
}

#if defined(__SSE2__)
TEST_CASE("C6: with denormals flushed to zero results stay whole") {
    unsigned const before = _mm_getcsr();
    _mm_setcsr(before | 0x8040U);  // flush to zero, denormals are zero
    auto const broken = broken_models(0, 150);
    _mm_setcsr(before);
    INFO(first_of(broken));
    CHECK(broken.empty());
}
#endif

TEST_CASE("C6: the global locale, of C and of C++, changes no byte") {
    /// Decimal commas and groups of digits, whatever is installed.
    struct commas : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    auto const everything = [] {
        indexed_mesh m = l_shape();
        for (vec3& p : m.positions) p *= 1234.5678;
        std::string all = encode_obj(m) + encode_ply(m, {}, {});
        indexed_mesh const back = read_obj(encode_obj(m), "a.obj").mesh;
        all += back == m ? "same" : "other";
        solid const s = make_solid(m);
        link_graph const g = make_link_graph(voronoi_shards(s, std::vector<vec3>{s.bounds.centre(), s.bounds.lo}));
        frost_run run(g);
        run.run({.paths = 50});
        for (std::byte const b : run.checkpoint()) all += static_cast<char>(b);
        return all;
    };
    std::string const before = everything();
    std::locale const old = std::locale::global(std::locale(std::locale::classic(), new commas));
    bool const c_too = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
    std::string const under = everything();
    std::locale::global(old);
    std::setlocale(LC_ALL, "C");
    INFO("with a German C locale: " << c_too);
    CHECK((under == before));
    CHECK(before.find("same") != std::string::npos);
}
