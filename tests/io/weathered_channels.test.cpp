#include <tafoni/io/weathered_channels.hpp>

#include <tafoni/io/read_ply.hpp>
#include <tafoni/io/write_ply.hpp>
#include <tafoni/io/write_vtp.hpp>

#include <catch2/catch.hpp>

#include "support/shapes.hpp"

using namespace tafoni;

namespace {

/// A tetrahedron with numbers that no two channels share.
weathered_surface some_surface() {
    weathered_surface s;
    s.surface.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (auto const& f : {std::array<std::uint32_t, 3>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) s.surface.mesh.add_face(f);
    s.surface.cell = {cell_index{7U}, cell_index{0U}, cell_index{3000000000U}, cell_index{1U}};
    s.surface.face.assign(4, face_index{0U});
    s.surface.fresh = {1, 0, 0, 1};
    s.life = {0.25, 1, 0.5, 0};
    s.hold = {0.75, 0.125, 0, 1};
    s.exposed = {1, 1, 0, 1};
    return s;
}

}  // namespace

TEST_CASE("a weathered surface goes through PLY with life, hold, exposure, shard and fresh on its faces") {
    weathered_surface const s = some_surface();
    mesh_attributes const a = channels_of(s);
    CHECK(a.vertex_channels.empty());
    for (auto const encoding : {ply_encoding::ascii, ply_encoding::little_endian}) {
        mesh_file const back = read_ply(encode_ply(s.surface.mesh, a, {.encoding = encoding}), "memory");
        auto const& channels = back.attributes.face_channels;
        REQUIRE(channels.size() == 5);
        auto const values = [&](char const* name) {
            auto const* const c = mesh_attributes::find(channels, name);
            REQUIRE(c != nullptr);
            return c->values;
        };
        CHECK(back.mesh.positions == s.surface.mesh.positions);
        CHECK(values("life") == s.life);
        CHECK(values("hold") == s.hold);
        CHECK(values("exposure") == std::vector<double>{1, 1, 0, 1});
        CHECK(values("shard") == std::vector<double>{7, 0, 3000000000.0, 1});
        CHECK(values("fresh") == std::vector<double>{1, 0, 0, 1});
    }
}

TEST_CASE("a weathered surface is written as .vtp with its first channel, life, as the one shown") {
    weathered_surface const s = some_surface();
    std::string const file = encode_vtp(s.surface.mesh, channels_of(s));
    CHECK(file.find("<CellData Scalars=\"life\">") != std::string::npos);
    for (char const* const name : {"life", "hold", "exposure", "shard", "fresh"}) {
        CHECK(file.find("Name=\"" + std::string(name) + "\"") != std::string::npos);
    }
}

TEST_CASE("an empty surface has empty channels") {
    mesh_attributes const a = channels_of(weathered_surface{});
    REQUIRE(a.face_channels.size() == 5);
    for (mesh_channel const& c : a.face_channels) CHECK(c.values.empty());
    CHECK_NOTHROW(encode_ply(indexed_mesh{}, a));
}
