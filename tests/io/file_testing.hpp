/// \file
/// What the tests of the readers and writers share: failures as values, and a folder of their own.
#ifndef TAFONI_TESTS_IO_FILE_TESTING_HPP
#define TAFONI_TESTS_IO_FILE_TESTING_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/random.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>

#include <unistd.h>

#include <bit>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace tafoni_test {

/// How a call failed; `happened` is false where it did not.
struct failure {
    bool happened = false;
    tafoni::errc code{};
    std::string what{};
    tafoni::error_place place{};
};

template <class F>
failure failure_of(F&& f) {
    try {
        static_cast<void>(f());
    } catch (tafoni::io_error const& e) {
        return {true, e.code(), e.what(), e.place()};
    } catch (tafoni::invalid_input const& e) {
        return {true, e.code(), e.what(), e.place()};
    }
    return {};
}

inline bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

/// A folder that goes when the test ends.
class scratch_folder {
public:
    scratch_folder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "tafoni-test-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
        std::filesystem::permissions(path_, std::filesystem::perms::all);
    }
    scratch_folder(scratch_folder const&) = delete;
    scratch_folder& operator=(scratch_folder const&) = delete;
    ~scratch_folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
    }

private:
    std::filesystem::path path_;
};

inline std::string bytes_of(std::filesystem::path const& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void put_bytes(std::filesystem::path const& path, std::string_view bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// A finite double of any magnitude and sign, from random bits.
template <class Stream>
double any_finite(Stream& random) {
    for (;;) {
        double const value = std::bit_cast<double>(random.bits());
        if (value - value == 0) return value;
    }
}

/// Polygons of 3 to 7 corners over vertices with random bits.
template <class Stream>
tafoni::indexed_mesh any_mesh(Stream& random, std::size_t vertices, std::size_t faces) {
    tafoni::indexed_mesh mesh;
    for (std::size_t v = 0; v < vertices; ++v) {
        double const x = any_finite(random);
        double const y = any_finite(random);
        double const z = any_finite(random);
        mesh.add_vertex({x, y, z});
    }
    for (std::size_t f = 0; f < faces; ++f) {
        std::size_t const n = 3 + random.index_below(5);
        for (std::size_t k = 0; k < n; ++k) mesh.corners.push_back(static_cast<std::uint32_t>(random.index_below(vertices)));
        mesh.offsets.push_back(mesh.corners.size());
    }
    return mesh;
}

}  // namespace tafoni_test

#endif
