#include "percolation/box_network.hpp"

#include <tafoni/graph/surface_walk.hpp>
#include <tafoni/weathering/frost_presets.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;
using tafoni_test::box_network;

namespace {

errc refusal(auto& run, std::span<std::byte const> bytes) {
    try {
        run.resume(bytes);
    } catch (io_error const& e) {
        return e.code();
    }
    return errc{};
}

}  // namespace

TEST_CASE("a run that was saved and resumed ends in the same bytes") {
    box_network const n(5, 5, 5);
    auto const preset = addon_preset();
    frost_run whole(n, preset.process, preset.options);
    whole.mark(n.at(2, 2, 0), cell_state::core);
    whole.run({.paths = 1500});
    auto const saved = whole.checkpoint();
    whole.run({.paths = 1500});

    frost_run later(n, preset.process, preset.options);
    later.run({.paths = 77});  // whatever it did before
    later.resume(saved);
    CHECK((later.checkpoint() == saved));
    CHECK(later.paths() == 1500);
    later.run({.paths = 1500});
    CHECK((later.checkpoint() == whole.checkpoint()));
    CHECK(later.blocks().size() == whole.blocks().size());
    CHECK(later.report().water_absorbed == whole.report().water_absorbed);
    CHECK(later.blocks().back().volume == whole.blocks().back().volume);
    later.reset();
    CHECK(later.cell(n.at(2, 2, 0)) == cell_state::core);  // marks travel too
}

TEST_CASE("the paper's exposure depends on history, and resumes all the same") {
    box_network const n(4, 4, 4);
    auto const preset = addon_preset();
    frost_run whole(n, preset.process, preset.options, surface_walk{});
    whole.run({.paths = 1000});
    auto const saved = whole.checkpoint();
    whole.run({.paths = 1000});
    frost_run later(n, preset.process, preset.options, surface_walk{});
    later.resume(saved);
    later.run({.paths = 1000});
    CHECK((later.checkpoint() == whole.checkpoint()));
}

TEST_CASE("a checkpoint of another network, other options or other policies is refused") {
    box_network const n(3, 3, 3);
    box_network other(3, 3, 3);
    other.links[5].area = 1.5;
    auto const preset = paper_preset();
    frost_run run(n, preset.process, preset.options);
    run.run({.paths = 50});
    auto const saved = run.checkpoint();
    frost_run elsewhere(other, preset.process, preset.options);
    CHECK(refusal(elsewhere, saved) == errc::checkpoint_mismatch);
    frost_run seeded(n, preset.process, {.seed = 1});
    CHECK(refusal(seeded, saved) == errc::checkpoint_mismatch);
    auto changed = preset.process;
    changed.wear.harm.k_dmg = 0.6;
    frost_run harder(n, changed, preset.options);
    CHECK(refusal(harder, saved) == errc::checkpoint_mismatch);
    changed = preset.process;
    changed.flow.resistance.value = 0.6;
    frost_run denser(n, changed, preset.options);
    CHECK(refusal(denser, saved) == errc::checkpoint_mismatch);
    // Replaced between paths, saved, resumed by a run that has the replacement.
    run.replace(changed);
    denser.resume(run.checkpoint());
    CHECK((denser.checkpoint() == run.checkpoint()));
}

TEST_CASE("a checkpoint cut at any byte or with any byte changed is refused and nothing happens") {
    box_network const n(2, 2, 2);
    auto const preset = paper_preset();
    frost_run run(n, preset.process, preset.options);
    run.run({.paths = 400});
    auto const saved = run.checkpoint();
    REQUIRE(run.blocks().size() > 0);
    frost_run victim(n, preset.process, preset.options);
    victim.run({.paths = 7});
    auto const before = victim.checkpoint();
    for (std::size_t k = 0; k < saved.size(); ++k) {
        INFO("byte " << k);
        REQUIRE(refusal(victim, std::span(saved).first(k)) != errc{});
        auto damaged = saved;
        damaged[k] ^= std::byte{0x10};
        REQUIRE(refusal(victim, damaged) != errc{});
    }
    auto longer = saved;
    longer.push_back(std::byte{0});
    CHECK(refusal(victim, longer) == errc::bad_syntax);
    CHECK(refusal(victim, {}) == errc::wrong_format);
    CHECK((victim.checkpoint() == before));
}

TEST_CASE("a forged checkpoint with a right checksum is refused, or makes a run that works") {
    box_network const n(2, 2, 2);
    auto const preset = paper_preset();
    frost_run run(n, preset.process, preset.options);
    run.run({.paths = 400});
    auto const saved = run.checkpoint();
    REQUIRE(run.blocks().size() > 0);
    frost_run victim(n, preset.process, preset.options);
    victim.run({.paths = 7});
    auto const before = victim.checkpoint();
    int refused = 0;
    int taken = 0;
    for (std::uint64_t k = 0; k < 4000; ++k) {
        stream random(3, stage::user, k);
        auto forged = saved;
        std::uint64_t const changes = 1 + random.index_below(3);
        for (std::uint64_t c = 0; c < changes; ++c) {
            std::size_t const at = 44 + random.index_below(saved.size() - 52);  // past magic and hashes
            forged[at] = static_cast<std::byte>(random.chance(0.3) ? 0xFFU : random.index_below(256));
        }
        std::uint64_t const sum = detail::byte_hash(std::span(forged).first(forged.size() - 8));
        for (std::size_t b = 0; b < 8; ++b) forged[forged.size() - 8 + b] = static_cast<std::byte>(sum >> (8 * b) & 0xFF);
        if (refusal(victim, forged) != errc{}) {
            ++refused;
            REQUIRE((victim.checkpoint() == before));
            continue;
        }
        ++taken;
        frost_run other = victim;
        other.run({.paths = 20});
        std::uint64_t lost = 0;
        for (cell_state const c : other.cells()) lost += c == cell_state::air ? 1U : 0U;
        REQUIRE(other.report().cells_detached <= lost);
        victim.resume(before);
    }
    CHECK(refused > 1000);
    CHECK(taken > 100);
}

namespace {

struct stepped_flow {
    int steps = 1;
    [[nodiscard]] double weight(link_view const&, link_view const& there, water const&) const {
        return there.area * steps;
    }
};
struct plain_flow {
    [[nodiscard]] double weight(link_view const&, link_view const& there, water const&) const { return there.area; }
};
struct named_flow : plain_flow {
    static constexpr std::string_view name = "named";
};
struct other_flow : plain_flow {
    static constexpr std::string_view name = "other";
};
struct named_flood : air_flood {
    static constexpr std::string_view name = "mine";
};

template <class A, class B, class Exposure = air_flood>
errc exchanged(A const& from, B const& to, Exposure const& exposure = {}) {
    box_network const n(2, 2, 2);
    frost_run const run(n, frost_wedging{.flow = from});
    frost_run other(n, frost_wedging{.flow = to}, {}, exposure);
    return refusal(other, run.checkpoint());
}

}  // namespace

TEST_CASE("policies without parameters() are told apart by bytes, by name or by size, and so is the exposure") {
    CHECK(exchanged(stepped_flow{2}, stepped_flow{2}) == errc{});
    CHECK(exchanged(stepped_flow{2}, stepped_flow{3}) == errc::checkpoint_mismatch);
    CHECK(exchanged(stepped_flow{1}, plain_flow{}) == errc::checkpoint_mismatch);
    CHECK(exchanged(named_flow{}, named_flow{}) == errc{});
    CHECK(exchanged(named_flow{}, other_flow{}) == errc::checkpoint_mismatch);
    CHECK(exchanged(named_flow{}, plain_flow{}) == errc::checkpoint_mismatch);
    CHECK(exchanged(plain_flow{}, plain_flow{}, named_flood{}) == errc::checkpoint_mismatch);
}
