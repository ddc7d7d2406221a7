#include <catch2/catch.hpp>

#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/io/graph_vtp.hpp>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace tafoni;

namespace {

/// A file of its own that is gone afterwards.
struct scratch_file {
    std::filesystem::path path = std::filesystem::temp_directory_path() /
                                 ("tafoni_graph_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".vtp");
    ~scratch_file() {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
    std::string bytes() const {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

template <class T>
std::vector<T> array_of(std::string const& file, std::string const& name) {
    std::size_t const tag = file.find("Name=\"" + name + "\"");
    REQUIRE(tag != std::string::npos);
    std::size_t const at = file.find("offset=\"", tag) + 8;
    std::size_t const offset = std::strtoull(file.c_str() + at, nullptr, 10);
    std::size_t const blob = file.find('_', file.find("<AppendedData")) + 1;
    std::uint64_t length = 0;
    std::memcpy(&length, file.data() + blob + offset, 8);
    std::vector<T> values(length / sizeof(T));
    std::memcpy(values.data(), file.data() + blob + offset + 8, length);
    return values;
}

bool contains(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the links graph is written as a point per link and a line per pair of neighbours") {
    auto const rock = voxel_cells::from_predicate({.size = {2, 1, 1}}, [](vec3 const&) { return true; });
    link_graph const graph = make_link_graph(rock);
    std::vector<double> life(graph.link_count(), 0.0);
    life[0] = 0.75;
    scratch_file const stored;
    write_links(stored.path, graph, {.life = life});
    std::string const text = stored.bytes();
    // One bond with 8 neighbours, 10 skin links with 4 each.
    CHECK(contains(text, "NumberOfPoints=\"11\" NumberOfVerts=\"0\" NumberOfLines=\"24\""));
    CHECK(array_of<double>(text, "life")[0] == 0.75);
    CHECK(array_of<double>(text, "Points")[0] == 1);
    CHECK(array_of<std::uint8_t>(text, "interior")[0] == 1);
    CHECK(array_of<std::uint8_t>(text, "interior")[1] == 0);
    // The computed network has unused slots, which are left out.
    scratch_file const computed;
    std::vector<link_state> const states(rock.link_count(), link_state::skin);
    write_links(computed.path, rock, {.states = states});
    CHECK(contains(computed.bytes(), "NumberOfPoints=\"11\" NumberOfVerts=\"0\" NumberOfLines=\"24\""));
    CHECK(array_of<std::uint8_t>(computed.bytes(), "state") == std::vector<std::uint8_t>(11, 2));
}

TEST_CASE("the cells graph is written as a point per cell and a line per bond") {
    auto const rock = voxel_cells::from_predicate({.size = {3, 3, 1}}, [](vec3 const&) { return true; });
    std::vector<vec3> centroids;
    for (std::uint32_t c = 0; c < rock.cell_count(); ++c) centroids.push_back(rock.cell_centroid(cell_index{c}));
    scratch_file const file;
    write_bonds(file.path, rock, centroids);
    CHECK(contains(file.bytes(), "NumberOfPoints=\"9\" NumberOfVerts=\"0\" NumberOfLines=\"12\""));
    CHECK_THROWS_AS(write_bonds(file.path, rock, std::vector<vec3>{}), invalid_input);
}

TEST_CASE("paths are written through the centroids of their links with the water that is left") {
    auto const rock = voxel_cells::from_predicate({.size = {1, 1, 3}}, [](vec3 const&) { return true; });
    link_graph const graph = make_link_graph(rock);
    std::vector<link_index> const links{link_index{0U}, link_index{1U}};
    std::vector<double> const water{1.0, 0.5};
    scratch_file const file;
    write_paths(file.path, graph, std::vector<water_path>{{links, water}, {{}, {}}, {links, {}}});
    std::string const text = file.bytes();
    CHECK(contains(text, "NumberOfPoints=\"4\" NumberOfVerts=\"0\" NumberOfLines=\"2\""));
    CHECK(array_of<double>(text, "water") == std::vector<double>{1, 0.5, 1, 1});
    CHECK(array_of<std::uint32_t>(text, "path") == std::vector<std::uint32_t>{0, 2});
    std::vector<link_index> const bad{link_index{9999U}};
    CHECK_THROWS_AS(write_paths(file.path, graph, std::vector<water_path>{{bad, {}}}), invalid_input);
    CHECK_THROWS_AS(write_paths(file.path, graph, std::vector<water_path>{{links, std::span{water}.first(1)}}), invalid_input);
    std::vector<double> const life(3, 1.0);
    CHECK_THROWS_AS(write_links(file.path, graph, {.life = life}), invalid_input);
}
