// INPUT: a mesh file, an elevation grid, or a builtin rock.
#pragma once

#include <tafoni/geometry/solid.hpp>
#include <tafoni/io/read_mesh.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

namespace weather {

struct rock_input {
    tafoni::solid body;
    bool terrain = false;              ///< from an elevation grid: sides and base are artificial
    nlohmann::ordered_json repaired;   ///< what was mended, as counts
};

/// Reads .obj, .ply, .stl or .asc, or makes `builtin:outcrop[:resolution=40]`. Orientation is mended on
/// request of the tool; anything else that is wrong is an error of the library.
rock_input load_rock(std::string const& name, std::uint64_t seed);

/// Reads a mesh. Where neither its bytes nor its name say which kind of file it is, all kinds that INPUT may be are named:
/// `others` ends the list. \throws tafoni::io_error
tafoni::mesh_file read_model(std::string const& path, char const* others);

/// Points of a file: the vertices of a mesh, or lines of three numbers.
std::vector<tafoni::vec3> load_points(std::string const& path);

/// Numbers of a text file, separated by white space or commas.
std::vector<double> load_reals(std::string const& path);

/// Whole numbers of a text file, separated by white space or commas.
std::vector<std::uint64_t> load_numbers(std::string const& path);

/// The bytes of a file. \throws tafoni::io_error
std::string load_bytes(std::string const& path);

/// What stands behind the last dot, in small letters.
std::string extension_of(std::string const& path);

/// True for names that end like a mesh file.
bool is_mesh_name(std::string const& path);

}  // namespace weather
