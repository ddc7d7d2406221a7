// What no reader may do, whatever the bytes: crash, point behind the end, or take more memory than the file allows.
#include <catch2/catch.hpp>

#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/io/obj.hpp>
#include <tafoni/io/ply.hpp>
#include <tafoni/io/read_nrrd.hpp>
#include <tafoni/io/read_pgm.hpp>
#include <tafoni/io/read_vox.hpp>
#include <tafoni/io/stl.hpp>
#include <tafoni/io/write_vox.hpp>

#include "file_testing.hpp"

#include <fuzz/check_mesh_file.hpp>

#include <malloc.h>

#include <cstdlib>
#include <functional>
#include <new>

using namespace tafoni;

namespace {

std::size_t held = 0;
std::size_t peak = 0;

void* counted(std::size_t size) {
    void* const p = std::malloc(size);
    if (p == nullptr) throw std::bad_alloc();
    held += ::malloc_usable_size(p);
    peak = std::max(peak, held);
    return p;
}
void discounted(void* p) {
    if (p == nullptr) return;
    held -= ::malloc_usable_size(p);
    std::free(p);
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, std::nothrow_t const&) noexcept { return counted(size); }
void* operator new[](std::size_t size, std::nothrow_t const&) noexcept { return counted(size); }
void operator delete(void* p) noexcept { discounted(p); }
void operator delete[](void* p) noexcept { discounted(p); }
void operator delete(void* p, std::size_t) noexcept { discounted(p); }
void operator delete[](void* p, std::size_t) noexcept { discounted(p); }

namespace {

using reader = void (*)(std::string_view);
void as_obj(std::string_view bytes) { tafoni_test::check_mesh_file(read_obj(bytes, "x")); }
void as_ply(std::string_view bytes) { tafoni_test::check_mesh_file(read_ply(bytes, "x")); }
void as_stl(std::string_view bytes) { tafoni_test::check_mesh_file(read_stl(bytes, "x")); }
void as_asc(std::string_view bytes) { static_cast<void>(read_esri_ascii(bytes, "x")); }
void as_vox(std::string_view bytes) { static_cast<void>(read_vox(bytes, "x")); }
void as_nrrd(std::string_view bytes) { read_nrrd(bytes, "x").validate(); }
void as_pgm(std::string_view bytes) { read_pgm(bytes, "x").validate(); }

indexed_mesh pyramid() {
    indexed_mesh m;
    m.positions = {{0, 0, 0}, {1.25, 0, 0}, {1, 1e-7, 0}, {0, 1, -0.5}, {0.5, 0.5, 2}};
    m.add_face({3, 2, 1, 0});
    m.add_face({0, 1, 4});
    m.add_face({1, 2, 4});
    return m;
}

struct sample {
    char const* name;
    reader read;
    std::string bytes;
};

std::vector<sample> samples() {
    mesh_attributes const extra{.vertex_channels = {{"red", {1, 2, 3, 4, 5}, channel_type::uint8}},
                                .face_channels = {{"life", {0.5, 0.25, 1}}}};
    return {
        {"plain OBJ", as_obj, encode_obj(pyramid())},
        {"full OBJ", as_obj, "mtllib a\nv 0 0 0 1 0 0\r\nv 1 0 0\rv 0 1 0\nvt 1 1\nvn 0 0 1\ng a b\nf 1/1/1 2//1 \\\n 3/-1\n# end\nf -1 -2 -3"},
        {"forward OBJ", as_obj, "f 1 2 3 4\nv 1e-3 .5 5.\nv 1 1 1\nv 2 2 2\nv 3 3 3e0\n"},
        {"ASCII PLY", as_ply, encode_ply(pyramid(), extra, {.encoding = ply_encoding::ascii})},
        {"little PLY", as_ply, encode_ply(pyramid(), extra)},
        {"big float PLY", as_ply, encode_ply(pyramid(), extra, {.encoding = ply_encoding::big_endian, .coordinates = coordinate_type::float32, .origin = {1, 2, 3}})},
        {"ASCII STL", as_stl, "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"},
        {"binary STL", as_stl, encode_stl(pyramid())},
        {"grid in rows", as_asc, "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1.5\nNODATA_value -9999\n1 2 3\n4 -9999 6\n"},
        {"voxel models", as_vox, encode_vox({.models = {{{2, 3, 4}, {{0, 0, 0, 1}, {1, 2, 3, 7}}}, {{1, 1, 1}, {}}}})},
        {"little volume", as_nrrd, "NRRD0004\n# c\ntype: short\ndimension: 3\nsizes: 2 1 2\nencoding: raw\nendian: big\nspacings: 1 1.5 2\nspace origin: (0,0,-1e3)\n\nabcdefgh"},
        {"numbers of grey", as_pgm, "P2 # c\n3 2\r\n255\n1 2 3\n40 50 60"},
        {"bytes of grey", as_pgm, "P5\n2 2 9999\n\1\2\3\4\5\6\7\10"},
        {"grid that flows", as_asc, "NCOLS 2\rNROWS 2\rXLLCENTER 0\rYLLCENTER 0\rDX 1\rDY 2\r1\r2\r3\r4e2"},
    };
}

/// Reads; an error has to be an io_error that points into the bytes. Returns whether it was read.
bool read_or_refuse(reader read, std::string_view bytes) {
    try {
        read(bytes);
        return true;
    } catch (io_error const& e) {
        REQUIRE(e.place().line <= bytes.size() + 1);
        REQUIRE(e.place().column <= bytes.size() + 1);
        REQUIRE(std::string_view(e.what()).size() < 300);
        return false;
    }
}

}  // namespace

TEST_CASE("every prefix of small files is refused with a place inside it, or is a valid file") {
    for (sample const& s : samples()) {
        INFO(s.name);
        REQUIRE(read_or_refuse(s.read, s.bytes));
        std::size_t refused = 0;
        for (std::size_t n = 0; n < s.bytes.size(); ++n) {
            // A copy of exactly this size, so that the address sanitizer sees a step beyond the end.
            std::vector<char> const prefix(s.bytes.begin(), s.bytes.begin() + static_cast<std::ptrdiff_t>(n));
            if (!read_or_refuse(s.read, {prefix.data(), n})) ++refused;
        }
        CHECK(refused > 0);
    }
}

TEST_CASE("binary files are refused at every shorter length") {
    for (sample const& s : samples()) {
        if (std::string_view(s.name).find("little") == std::string_view::npos && std::string_view(s.name) != "binary STL") continue;
        for (std::size_t n = 0; n < s.bytes.size(); ++n) REQUIRE_FALSE(read_or_refuse(s.read, std::string_view(s.bytes).substr(0, n)));
    }
}

TEST_CASE("a thousand random changes of each small file are refused or read, never worse") {
    stream random(52, stage::user, 0);
    for (sample const& s : samples()) {
        INFO(s.name);
        for (int round = 0; round < 1000; ++round) {
            std::string bytes = s.bytes;
            std::uint64_t const changes = 1 + random.index_below(4);
            for (std::uint64_t k = 0; k < changes; ++k) {
                std::size_t const at = random.index_below(bytes.size());
                std::uint64_t const kind = random.index_below(4);
                char const byte = static_cast<char>(random.index_below(256));
                if (kind == 0) bytes.erase(at, 1 + random.index_below(3));
                if (kind == 1) bytes.insert(at, 1, byte);
                if (kind == 2) bytes[at] = byte;
                if (kind == 3) bytes[at] = "0123456789.-eE \n/"[random.index_below(17)];
                if (bytes.empty()) bytes = "0";
            }
            static_cast<void>(read_or_refuse(s.read, bytes));
        }
    }
}

TEST_CASE("no reader takes more than 16 times the file and one megabyte") {
    auto const repeated = [](std::string head, std::string_view piece, std::size_t times, std::string_view tail = "") {
        for (std::size_t k = 0; k < times; ++k) head += piece;
        return head += tail;
    };
    // Just beyond a power of two vertices, and of two corners: where arrays have doubled for one more entry.
    std::size_t const many = GENERATE(174763U, 262145U);
    std::string const ascii = "ply\nformat ascii 1.0\nelement vertex ";
    std::string const binary = "ply\nformat binary_little_endian 1.0\nelement vertex ";
    std::string const xyz = "\nproperty uchar x\nproperty uchar y\nproperty uchar z\n";
    std::string const faces = "property list uchar uchar vertex_indices\nend_header\n";
    using namespace std::string_literals;
    std::vector<sample> const worst = {
        {"short vertices", as_obj, repeated("", "v 0 0 0\n", many)},
        {"coloured vertices", as_obj, repeated("", "v 0 0 0 0 0 0 0\n", many)},
        {"late colours", as_obj, repeated("", "v 0 0 0\n", many, "v 0 0 0 0 0 0 0\n")},
        {"short texture", as_obj, repeated("", "vt 0\n", many)},
        {"short normals", as_obj, repeated("", "vn 0 0 0\n", many)},
        {"short faces", as_obj, repeated("v 0 0 0\n", "f 1 1 1\n", many)},
        {"faces that lead nowhere", as_obj, repeated("v 0 0 0\n", "f 2 1 1\n", many)},
        {"one huge face", as_obj, repeated("v 0 0 0\nf", " 1", many)},
        {"texture in the last face", as_obj, repeated("v 0 0 0\nvt 0\nvn 0 0 0\n", "f 1 1 1\n", many, "f 1/1/1 1 1\n")},
        {"a group per face", as_obj, repeated("v 0 0 0\n", "g a\nf 1 1 1\n", many)},
        {"an object, group and material per face", as_obj, repeated("v 0 0 0\n", "g a\no a\nusemtl a\nf 1 1 1\n", many)},
        {"material libraries", as_obj, repeated("", "mtllib a\n", many)},
        {"group names of 16 bytes", as_obj, repeated("v 0 0 0\n", "g 1234567890123456\nf 1 1 1\n", many)},
        {"ASCII vertices", as_ply, repeated(ascii + std::to_string(many) + xyz + "end_header\n", "0 0 0\n", many)},
        {"binary vertices", as_ply, repeated(binary + std::to_string(many) + xyz + "property char a\nproperty char b\nend_header\n", "\0\0\0\0\0"s, many)},
        {"binary faces", as_ply, repeated(binary + "1" + xyz + "element face " + std::to_string(many) + "\n" + faces + "\0\0\0"s, "\3\0\0\0"s, many)},
        {"faces claimed only", as_ply, binary + "1" + xyz + "element face 4000000000\n" + faces + std::string(400000, '\0')},
        {"vertices claimed only", as_ply, binary + "4294967295" + xyz + "end_header\n" + std::string(400000, '\0')},
        {"many properties", as_ply, repeated(binary + "1" + xyz, "property char a\n", many)},
        {"many elements", as_ply, repeated(binary + "1" + xyz, "element a 1\n", many)},
        {"STL soup", as_stl, [] {
             std::string soup(80, ' ');
             detail::append_little(soup, std::uint32_t{20000});
             for (std::uint32_t t = 0; t < 20000; ++t) {
                 for (std::uint32_t k = 0; k < 12; ++k) detail::append_little(soup, static_cast<float>(12 * t + k));
                 soup += "\1\0"s;
             }
             return soup;
         }()},
        {"STL count only", as_stl, std::string(80, ' ') + "\xff\xff\xff\xff"},
        {"ASCII STL", as_stl, repeated("solid\n", "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 0 1 vertex 0 1 0 endloop endfacet\n", 20000, "endsolid\n")},
        {"solids", as_stl, repeated("", "solid facet normal\nfacet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 0 1 vertex 0 1 0 endloop endfacet endsolid\n", 20000)},
        {"short heights", as_asc, repeated("ncols " + std::to_string(many) + "\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nnodata_value 0\n", "0 ", many)},
        {"heights claimed only", as_asc, "ncols 4294967295\nnrows 4294967295\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + std::string(400000, ' ')},
        {"a long word", as_asc, std::string(1000000, 'n')},
        {"empty models", as_vox, [&] {
             std::string const one = encode_vox({.models = {{{256, 256, 256}, {}}}}).substr(20);
             std::string chunks;
             for (std::size_t k = 0; k < many / 10; ++k) chunks += one;
             std::string file = encode_vox({.models = {{{1, 1, 1}, {}}}}).substr(0, 16);
             detail::append_little(file, static_cast<std::uint32_t>(chunks.size()));
             return file + chunks;
         }()},
        {"voxels claimed only", as_vox, encode_vox({.models = {{{9, 9, 9}, {}}}}).substr(0, 56) + "\xff\xff\xff\xff"},
        {"bytes of a volume", as_nrrd, "NRRD0004\ntype: uchar\ndimension: 3\nsizes: " + std::to_string(many) + " 1 1\nencoding: raw\n\n" + std::string(many, 'a')},
        {"a volume claimed only", as_nrrd, "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1048576 1048576 1048576\nencoding: raw\n\n" + std::string(many, 'a')},
        {"a spacing of many numbers", as_nrrd, repeated("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1 1 1\nencoding: raw\nspacings:", " 1", many, "\n\na")},
        {"short greys", as_pgm, repeated("P2 " + std::to_string(many) + " 1 1", " 0", many)},
        {"greys claimed only", as_pgm, "P2 2147483647 2147483647 1" + std::string(400000, ' ')},
    };
    for (sample const& s : worst) {
        std::size_t const before = held;
        peak = held;
        try {
            s.read(s.bytes);
        } catch (io_error const&) {
        }
        std::size_t const kept = held - before;
        // The reader of a path holds the bytes of the file as well.
        std::size_t const most = peak - before + s.bytes.size();
        INFO(s.name << ": " << static_cast<double>(most) / static_cast<double>(s.bytes.size()) << " times "
                    << s.bytes.size() << " bytes");
        CHECK(most <= 16 * s.bytes.size() + (1U << 20));
        CHECK(kept == 0);
    }
}
