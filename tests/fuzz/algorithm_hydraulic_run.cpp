// Bytes make a mesh, water, a rule and a plan: hydraulic erosion keeps its ledger, its numbers and its checkpoints.
#include "check_mesh_file.hpp"
#include "damaged_checkpoint.hpp"
#include "random_soup.hpp"

#include <tafoni/weathering/hydraulic_run.hpp>

namespace {

using namespace tafoni;
using tafoni_test::choices;
using tafoni_test::require;

/// Slides straight on, a particle on another way than the next.
struct sliding {
    std::vector<vec3> at{};
    std::vector<vec3> speed{};
    double radius = 1;
    std::size_t particle_count() const { return at.size(); }
    vec3 position(std::size_t i) const { return at[i]; }
    vec3 velocity(std::size_t i) const { return speed[i]; }
    double reach() const { return radius; }
    double step(fluid_boundary auto const&, executor auto const&) {
        for (std::size_t i = 0; i < at.size(); ++i) at[i] += 0.1 * speed[i];
        return 0.1;
    }
    void save(auto& out) const {
        for (vec3 const& p : at) {
            for (int d = 0; d < 3; ++d) out.put_real(p[d]);
        }
    }
    void load(auto& in) {
        for (vec3& p : at) {
            for (int d = 0; d < 3; ++d) p[d] = in.get_real();
        }
    }
};

struct any_rule {
    double k = 0;
    double turn = 0;  ///< lays down beyond it
    double rate(wash_point const& at) const { return (at.position[0] > turn ? -k : k) * length(at.velocity); }
};

template <class Run>
void check_run(Run const& run) {
    triangle_surface const& s = run.surface();
    for (auto const& t : s.triangles) {
        for (std::uint32_t const v : t) require(v < s.positions.size(), "corners are vertices");
    }
    for (vec3 const& p : s.positions) require(is_finite(p), "positions are finite");
    for (double const w : run.wear()) require(w >= 0 && std::isfinite(w), "ways are finite");
    for (double const v : run.sediment()) require(std::isfinite(v), "sediment is finite");
    require(run.balanced(), "law 29: the ledger closes");
    sediment_ledger const l = run.report().ledger;
    require(l.eroded >= 0 && l.deposited >= 0 && l.left >= 0, "volumes are not below 0");
    require(l.carried >= 0 || l.left == 0, "what is lent is of what has left first");
    require(run.wear().size() == s.positions.size() && run.flow().size() == s.positions.size(), "numbers per vertex");
}

template <class Process>
void wash(triangle_surface const& s, choices& c, double edge, Process const& process, sliding const& water) {
    hydraulic_options options{.step_divisor = 1 + 20 * c.unit()};
    if (c.chance(0.3)) options.refine_length = edge * (0.7 + c.unit());
    options.refine_every = static_cast<std::uint32_t>(1 + c.below(4));
    options.check_every = static_cast<std::uint32_t>(c.below(3));
    hydraulic_run run(s, water, process, options);
    hydraulic_run same(s, water, process, options);
    for (std::uint64_t act = 1 + c.below(3); act-- > 0;) {
        std::uint64_t const n = c.below(6);
        run.run(n);
        check_run(run);
        std::uint64_t const first = c.below(n + 1);
        same.run(first);
        auto const middle = same.checkpoint();
        same.resume(middle);
        require(same.checkpoint() == middle, "a checkpoint comes back as it was");
        same.run(n - first);
        require(same.surface().positions == run.surface().positions && same.sediment() == run.sediment(),
                "n then m iterations are n + m, also over checkpoints");
    }
    tafoni_test::resume_damaged(run, c);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    choices c(std::span(bytes, size));
    triangle_surface const s = tafoni_test::random_soup(c);
    double const edge = s.mean_edge_length();
    sliding water{.radius = edge > 0 ? edge * (0.1 + 2 * c.unit()) : 1.0};
    for (std::uint64_t k = c.below(40); k-- > 0;) {
        vec3 const& a = s.positions[c.below(s.positions.size())];
        vec3 const& b = s.positions[c.below(s.positions.size())];
        double const t = c.unit();
        vec3 const off{edge * (c.unit() - 0.5), edge * (c.unit() - 0.5), edge * (c.unit() - 0.5)};
        water.at.push_back(a + t * (b - a) + off);
        water.speed.push_back(vec3{edge * (c.unit() - 0.5), edge * (c.unit() - 0.5), edge * c.unit()});
    }
    double const fast = c.chance(0.3) ? 1e3 : c.chance(0.5) ? 1e-3 : 1.0;
    switch (c.below(3)) {
    case 0: wash(s, c, edge, partheniades_erosion{.coefficient = fast * edge, .critical = c.unit(), .exponent = 0.5 + c.unit()}, water); break;
    case 1: wash(s, c, edge, curvature_erosion<>{.power = 1 + 2 * c.unit(), .influence = 3 * edge * c.unit()}, water); break;
    default: wash(s, c, edge, any_rule{.k = fast, .turn = s.positions.front()[0]}, water); break;
    }
    return 0;
}
