#include "percolation/box_network.hpp"

#include <tafoni/percolation/entry_tree.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;

namespace {

double const no_key[3] = {0, 0, 0};

std::vector<double> frequencies(entry_tree const& tree, std::size_t links, int n, auto const& accept) {
    std::vector<double> seen(links, 0);
    entry_tree::scratch memory;
    for (int k = 0; k < n; ++k) {
        stream random(9, stage::entry, static_cast<std::uint64_t>(k));
        link_index const l = tree.draw(random, no_key, accept, memory);
        if (l.valid()) seen[l.value] += 1;
    }
    return seen;
}

std::vector<double> expectation(entry_tree const& tree, std::size_t links, int n, auto const& accept) {
    std::vector<double> p(links, 0);
    double sum = 0;
    for (std::size_t i = 0; i < links; ++i) {
        p[i] = static_cast<double>(tree.weight(link_index{i})) * accept(link_index{i});
        sum += p[i];
    }
    for (double& v : p) v *= n / sum;
    return p;
}

}  // namespace

TEST_CASE("law 14: entry frequency is weight times acceptance, by rejection and by the exact draw") {
    std::size_t const links = 100;
    entry_tree tree(links);
    stream random(4, stage::user, 0);
    for (std::size_t i = 0; i < links; ++i) {
        if (i % 3 != 0) tree.set(link_index{i}, static_cast<std::int64_t>(1 + random.index_below(1000)));
    }
    int const n = 200000;
    auto const likely = [](link_index l) { return 0.2 + 0.008 * (l.value % 100); };
    CHECK(tafoni_test::chi_square_passes(frequencies(tree, links, n, likely), expectation(tree, links, n, likely)));
    // Accepts so rarely that nearly every draw ends in the exact one.
    auto const rare = [](link_index l) { return l.value % 7 == 0 ? 0.0 : 1e-5 * (1 + l.value % 5); };
    CHECK(tafoni_test::chi_square_passes(frequencies(tree, links, n, rare), expectation(tree, links, n, rare)));
}

TEST_CASE("a draw ends where nothing accepts or nothing has weight") {
    entry_tree tree(20);
    entry_tree::scratch memory;
    stream random(1, stage::entry, 0);
    auto const all = [](link_index) { return 1.0; };
    auto const none = [](link_index) { return 0.0; };
    CHECK_FALSE(tree.draw(random, no_key, all, memory).valid());
    tree.set(link_index{7u}, 3);
    CHECK_FALSE(tree.draw(random, no_key, none, memory).valid());
    CHECK(tree.draw(random, no_key, all, memory) == link_index{7u});
    tree.set(link_index{7u}, 0);
    CHECK(tree.total() == 0);
    CHECK_FALSE(tree.draw(random, no_key, all, memory).valid());
    CHECK_FALSE(entry_tree{}.draw(random, no_key, all, memory).valid());
}

TEST_CASE("draws depend on the weights, not on the order in which they were set") {
    entry_tree forward(1000);
    entry_tree backward(1000);
    for (std::uint32_t i = 0; i < 1000; ++i) forward.set(link_index{i}, i % 13);
    for (std::uint32_t i = 1000; i-- > 0;) {
        backward.set(link_index{i}, 99);
        backward.set(link_index{i}, i % 13);
    }
    auto const accept = [](link_index l) { return l.value % 2 == 0 ? 1e-4 : 0.0; };
    entry_tree::scratch a;
    for (std::uint64_t k = 0; k < 500; ++k) {
        entry_tree::scratch fresh;
        stream one(2, stage::entry, k);
        stream two(2, stage::entry, k);
        CHECK(forward.draw(one, no_key, accept, a) == backward.draw(two, no_key, accept, fresh));
    }
}

TEST_CASE("the exact draw follows changes of weights and of the direction") {
    entry_tree tree(50);
    for (std::uint32_t i = 0; i < 50; ++i) tree.set(link_index{i}, 10);
    entry_tree::scratch memory;
    auto const only = [](std::uint32_t a, std::uint32_t b) {
        return [a, b](link_index l) { return l.value == a || l.value == b ? 1e-9 : 0.0; };
    };
    double const other_key[3] = {1, 0, 0};
    for (std::uint64_t k = 0; k < 50; ++k) {
        stream random(6, stage::entry, k);
        link_index const first = tree.draw(random, no_key, only(3, 4), memory);
        CHECK((first.value == 3 || first.value == 4));
        CHECK(tree.draw(random, other_key, only(7, 7), memory).value == 7);
        tree.set(link_index{3u}, 0);
        CHECK(tree.draw(random, other_key, only(3, 4), memory).value == 4);
        tree.set(link_index{3u}, 10);
        tree.invalidate();
        CHECK(tree.draw(random, other_key, only(8, 8), memory).value == 8);
    }
}

TEST_CASE("links are visited in ascending order, those without weight are not") {
    entry_tree tree(700);
    std::vector<std::uint32_t> const expected{0, 8, 63, 64, 511, 512, 699};
    for (std::uint32_t const i : expected) tree.set(link_index{i}, 1);
    std::vector<std::uint32_t> seen;
    tree.for_each([&](link_index l) { seen.push_back(l.value); });
    CHECK(seen == expected);
    CHECK(tree.total() == 7);
}
