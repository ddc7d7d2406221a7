#include <catch2/catch.hpp>

#include "file_testing.hpp"

#include <support/test_data.hpp>

#include <tafoni/io/fill_from_vox.hpp>
#include <tafoni/io/read_vox.hpp>
#include <tafoni/io/write_vox.hpp>
#include <tafoni/voxel/sparse_grid.hpp>

using namespace tafoni;
using tafoni_test::failure_of;
using namespace std::string_literals;

namespace {

std::string chunk(std::string const& id, std::string const& content, std::string const& children = "") {
    std::string r = id;
    detail::append_little(r, static_cast<std::uint32_t>(content.size()));
    detail::append_little(r, static_cast<std::uint32_t>(children.size()));
    return r + content + children;
}
std::string words(std::initializer_list<std::uint32_t> values) {
    std::string r;
    for (std::uint32_t const v : values) detail::append_little(r, v);
    return r;
}
std::string file_of(std::string const& chunks, std::uint32_t version = 150) {
    return "VOX "s + words({version}) + chunk("MAIN", "", chunks);
}
std::string const size_chunk = chunk("SIZE", words({2, 3, 4}));
std::string const voxels_chunk = chunk("XYZI", words({2}) + "\0\0\0\1\1\2\3\7"s);

bool refused(std::string const& bytes, errc code) {
    auto const f = failure_of([&] { return read_vox(bytes, "x.vox"); });
    INFO(f.what);
    CHECK(f.happened);
    CHECK(f.code == code);
    CHECK(tafoni_test::contains(f.what, "read_vox: x.vox: byte "));
    return f.happened && f.code == code;
}

}  // namespace

TEST_CASE("models come with size, places and colours, whatever other chunks stand between") {
    std::string const palette = chunk("RGBA", std::string(1024, 'c'));
    std::string const scene = chunk("nTRN", "anything");
    for (std::uint32_t const version : {150U, 200U}) {
        vox_file const file = read_vox(file_of(chunk("PACK", words({2})) + size_chunk + voxels_chunk + size_chunk + chunk("XYZI", words({0})) + scene + palette, version), "x");
        REQUIRE(file.version == version);
        REQUIRE(file.models.size() == 2);
        REQUIRE(file.models[0] == vox_model{{2, 3, 4}, {{0, 0, 0, 1}, {1, 2, 3, 7}}});
        REQUIRE(file.models[1] == vox_model{{2, 3, 4}, {}});
    }
}

TEST_CASE("what is written comes back, and writing that gives the same bytes") {
    stream random(5, stage::user, 0);
    for (int round = 0; round < 20; ++round) {
        vox_file file{.version = round % 2 == 0 ? 150U : 200U};
        std::uint64_t const models = 1 + random.index_below(3);
        for (std::uint64_t m = 0; m < models; ++m) {
            vox_model model;
            for (std::size_t& n : model.size) n = 1 + random.index_below(256);
            std::uint64_t const count = random.index_below(50);
            for (std::uint64_t v = 0; v < count; ++v) {
                vox_voxel at;
                at.x = static_cast<std::uint8_t>(random.index_below(model.size[0]));
                at.y = static_cast<std::uint8_t>(random.index_below(model.size[1]));
                at.z = static_cast<std::uint8_t>(random.index_below(model.size[2]));
                at.colour = static_cast<std::uint8_t>(random.index_below(256));
                model.voxels.push_back(at);
            }
            file.models.push_back(model);
        }
        std::string const bytes = encode_vox(file);
        REQUIRE(read_vox(bytes, "x") == file);
        REQUIRE(encode_vox(read_vox(bytes, "x")) == bytes);
    }
    tafoni_test::scratch_folder const folder;
    vox_file const one{.models = {{{1, 1, 1}, {{0, 0, 0, 9}}}}};
    write_vox(folder / "a.vox", one);
    REQUIRE(read_vox(folder / "a.vox") == one);
}

TEST_CASE("what is no such file, or no whole one, is refused with the byte") {
    REQUIRE(refused("", errc::empty_input));
    REQUIRE(refused("V", errc::truncated));
    REQUIRE(refused("VOX2", errc::wrong_format));
    REQUIRE(refused("ply\n", errc::wrong_format));
    REQUIRE(refused(file_of(size_chunk + voxels_chunk, 151), errc::unsupported));
    REQUIRE(refused("VOX "s + words({150}) + chunk("MINE", ""), errc::bad_syntax));
    REQUIRE(refused(file_of(""), errc::empty_input));
    REQUIRE(refused(file_of(voxels_chunk), errc::bad_syntax));
    REQUIRE(refused(file_of(size_chunk), errc::truncated));
    REQUIRE(refused(file_of(size_chunk + size_chunk + voxels_chunk), errc::bad_syntax));
    REQUIRE(refused(file_of(chunk("PACK", words({2})) + size_chunk + voxels_chunk), errc::bad_count));
    REQUIRE(refused(file_of(chunk("SIZE", words({0, 1, 1})) + voxels_chunk), errc::bad_count));
    REQUIRE(refused(file_of(chunk("SIZE", words({1, 257, 1})) + voxels_chunk), errc::bad_count));
    REQUIRE(refused(file_of(chunk("SIZE", words({0xffffffffU, 0xffffffffU, 0xffffffffU})) + voxels_chunk), errc::bad_count));
    REQUIRE(refused(file_of(chunk("SIZE", words({1, 1})) + voxels_chunk), errc::truncated));
    REQUIRE(refused(file_of(chunk("SIZE", words({1, 1, 1, 1})) + voxels_chunk), errc::bad_count));
    REQUIRE(refused(file_of(size_chunk + chunk("XYZI", words({3}) + "\0\0\0\1"s)), errc::truncated));
    REQUIRE(refused(file_of(size_chunk + chunk("XYZI", words({0xffffffffU}) + "\0\0\0\1"s)), errc::truncated));
    REQUIRE(refused(file_of(size_chunk + chunk("XYZI", words({0}) + "\0\0\0\1"s)), errc::bad_count));
    REQUIRE(refused(file_of(size_chunk + chunk("XYZI", "ab")), errc::truncated));
    REQUIRE(refused(file_of(size_chunk + chunk("XYZI", words({1}) + "\2\0\0\1"s)), errc::out_of_range));
    REQUIRE(refused(file_of(size_chunk + chunk("XYZI", words({1}) + "\0\0\4\1"s)), errc::out_of_range));
    REQUIRE(refused(file_of(size_chunk + voxels_chunk) + "x", errc::bad_count));
    REQUIRE(refused("VOX "s + words({150}) + "MAIN" + words({0, 0xffffffffU}), errc::truncated));
}

TEST_CASE("every shorter length of a whole file is refused") {
    std::string const bytes = file_of(size_chunk + voxels_chunk + chunk("RGBA", std::string(40, 'c')));
    REQUIRE(read_vox(bytes, "x").models.size() == 1);
    for (std::size_t n = 0; n < bytes.size(); ++n) REQUIRE(failure_of([&] { return read_vox(std::string_view(bytes).substr(0, n), "x"); }).happened);
}

TEST_CASE("models that cannot be written are refused") {
    auto const code_of = [](vox_file const& f) { return failure_of([&] { return encode_vox(f); }).code; };
    REQUIRE(code_of({}) == errc::empty_input);
    REQUIRE(code_of({.version = 1, .models = {{}}}) == errc::unsupported);
    REQUIRE(code_of({.models = {{{0, 1, 1}, {}}}}) == errc::bad_count);
    REQUIRE(code_of({.models = {{{257, 1, 1}, {}}}}) == errc::bad_count);
    REQUIRE(code_of({.models = {{{1, 1, 1}, {{0, 1, 0, 1}}}}}) == errc::out_of_range);
}

TEST_CASE("a model fills a grid of its size, by colour") {
    vox_model const model{{2, 3, 4}, {{0, 0, 0, 1}, {1, 2, 3, 7}, {0, 1, 2, 0}}};
    for (up_axis const up : {up_axis::plus_z, up_axis::minus_y}) {
        sparse_grid grid({.size = {2, 3, 4}}, up);
        grid.set({0, 0, 1}, voxel_state::rock);
        fill_from_vox(grid, model, [](std::uint8_t c) { return c == 7 ? voxel_state::colluvium : voxel_state::rock; });
        REQUIRE(grid.count(voxel_plane::solid) == 2);
        REQUIRE(grid_access<sparse_grid>::state(grid, 0, 0, 0) == voxel_state::rock);
        REQUIRE(grid_access<sparse_grid>::state(grid, 1, 2, 3) == voxel_state::colluvium);
    }
    sparse_grid wrong({.size = {2, 3, 5}});
    REQUIRE(failure_of([&] { return fill_from_vox(wrong, model); }).code == errc::bad_count);
    sparse_grid small({.size = {2, 3, 4}});
    small.set({0, 0, 1}, voxel_state::rock);
    REQUIRE(failure_of([&] { return fill_from_vox(small, vox_model{{2, 3, 4}, {{2, 0, 0, 1}}}); }).code == errc::out_of_range);
    REQUIRE(small.count(voxel_plane::rock) == 1);
}

TEST_CASE("real files hold as many voxels as their makers counted") {
    struct real { char const* name; std::array<std::size_t, 3> size; std::size_t voxels; };
    for (real const& r : {real{"volumes/sthelens_10m.vox", {80, 122, 47}, 214712}, real{"volumes/bigtujunga_ridge_30m.vox", {128, 128, 40}, 342771},
                          real{"volumes/cave_synthetic.vox", {120, 120, 60}, 578085}}) {
        auto const path = tafoni_test::find(r.name);
        if (path.empty()) {
            WARN("skipped: no data");
            return;
        }
        vox_file const file = read_vox(path);
        REQUIRE(file.models.size() == 1);
        REQUIRE(file.models[0].size == r.size);
        sparse_grid grid({.size = r.size});
        fill_from_vox(grid, file.models[0]);
        REQUIRE(grid.count(voxel_plane::rock) == r.voxels);
    }
}
