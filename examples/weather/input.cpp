#include "input.hpp"

#include "spec.hpp"

#include <tafoni/field/outcrop.hpp>
#include <tafoni/geometry/repair_solid.hpp>
#include <tafoni/geometry/terrain_solid.hpp>
#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/io/read_mesh.hpp>

#include <algorithm>
#include <charconv>

namespace weather {

namespace {

rock_input load_builtin(std::string const& name, std::uint64_t seed) {
    // builtin:outcrop:key=value reads as the SPEC behind the first colon.
    spec s = spec::parse("INPUT", name.substr(name.find(':') + 1));
    if (s.name() != "outcrop") s.fail("there is builtin:outcrop only");
    auto const resolution = static_cast<std::size_t>(s.number("resolution", 40, 4, 2000));
    auto const shape = static_cast<std::uint64_t>(s.number("seed", static_cast<double>(seed), 0, 1e15));
    s.done();
    return {.body = tafoni::make_solid(tafoni::make_outcrop(shape, resolution)), .repaired = {{"turned_faces", 0}}};
}

}  // namespace

std::string extension_of(std::string const& path) {
    std::size_t const dot = path.rfind('.');
    std::string e = dot == std::string::npos ? std::string() : path.substr(dot + 1);
    std::transform(e.begin(), e.end(), e.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    return e;
}

bool is_mesh_name(std::string const& path) {
    std::string const e = extension_of(path);
    return e == "obj" || e == "ply" || e == "stl";
}

std::string load_bytes(std::string const& path) {
    auto const file = tafoni::detail::load_file("weather", path);
    return std::string(file.bytes());
}

tafoni::mesh_file read_model(std::string const& path, char const* others) {
    try {
        return tafoni::read_mesh(std::filesystem::path(path));
    } catch (tafoni::io_error const& e) {
        if (e.code() != tafoni::errc::wrong_format || is_mesh_name(path)) throw;
    }
    tafoni::detail::fail<tafoni::io_error>(tafoni::errc::wrong_format,
                                           path + ": expected a mesh (.obj .ply .stl), " + others,
                                           {.kind = tafoni::entity::file, .file = path});
}

rock_input load_rock(std::string const& name, std::uint64_t seed) {
    if (name.rfind("builtin:", 0) == 0) return load_builtin(name, seed);
    if (extension_of(name) == "asc") {
        return {.body = tafoni::terrain_solid(tafoni::read_esri_ascii(std::filesystem::path(name))),
                .terrain = true,
                .repaired = {{"turned_faces", 0}}};
    }
    tafoni::mesh_file const file = read_model(name, "an elevation grid (.asc) or builtin:SPEC");
    tafoni::repaired_solid r = tafoni::repair_solid(file.mesh, {.orient = true});
    return {.body = std::move(r.body), .repaired = {{"turned_faces", r.report.turned_faces.size()}}};
}

std::vector<double> load_reals(std::string const& path) {
    std::string const bytes = load_bytes(path);
    std::vector<double> numbers;
    std::uint64_t line = 1;
    char const* at = bytes.data();
    char const* const end = at + bytes.size();
    while (at != end) {
        if (*at == '\n') ++line;
        if (*at == ' ' || *at == '\t' || *at == ',' || *at == '\r' || *at == '\n') {
            ++at;
            continue;
        }
        double v = 0;
        auto const r = std::from_chars(at, end, v);
        if (r.ec != std::errc{}) {
            tafoni::detail::fail<tafoni::io_error>(tafoni::errc::bad_number,
                                                   path + ": line " + std::to_string(line) + ": not a number",
                                                   {.kind = tafoni::entity::file, .file = path, .line = line});
        }
        numbers.push_back(v);
        at = r.ptr;
    }
    return numbers;
}

std::vector<tafoni::vec3> load_points(std::string const& path) {
    if (is_mesh_name(path)) return tafoni::read_mesh(std::filesystem::path(path)).mesh.positions;
    auto const numbers = load_reals(path);
    if (numbers.empty() || numbers.size() % 3 != 0) {
        tafoni::detail::fail<tafoni::io_error>(tafoni::errc::bad_count,
                                               path + ": " + std::to_string(numbers.size()) +
                                                   " numbers are no list of points x y z",
                                               {.kind = tafoni::entity::file, .file = path});
    }
    std::vector<tafoni::vec3> points;
    for (std::size_t i = 0; i < numbers.size(); i += 3) points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    return points;
}

std::vector<std::uint64_t> load_numbers(std::string const& path) {
    std::string const bytes = load_bytes(path);
    std::vector<std::uint64_t> numbers;
    char const* at = bytes.data();
    char const* const end = at + bytes.size();
    while (at != end) {
        if (*at == ' ' || *at == '\t' || *at == ',' || *at == '\r' || *at == '\n') {
            ++at;
            continue;
        }
        std::uint64_t v = 0;
        auto const r = std::from_chars(at, end, v);
        if (r.ec != std::errc{}) {
            tafoni::detail::fail<tafoni::io_error>(tafoni::errc::bad_number, path + ": not a list of whole numbers",
                                                   {.kind = tafoni::entity::file, .file = path});
        }
        numbers.push_back(v);
        at = r.ptr;
    }
    return numbers;
}

}  // namespace weather
