// What the processes on meshes leave behind: surfaces with numbers per vertex, time series, parts of the report.
#pragma once

#include "mesh_input.hpp"
#include "output.hpp"

#include <tafoni/geometry/triangle_surface.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace weather {

/// What was mended, on stderr.
void tell_repairs(mesh_input const& input);

/// The triangles with these numbers per vertex, and normals (nx, ny, nz), by which viewers shade smoothly.
surface_mesh mesh_with(tafoni::triangle_surface const& surface, std::vector<tafoni::mesh_channel> channels);

/// A channel of one number per vertex.
tafoni::mesh_channel vertex_numbers(char const* name, std::vector<double> values);

/// Volume of the closed chain, about the box's centre; of an open surface the part over it. O(faces).
double volume_of(tafoni::triangle_surface const& surface, tafoni::box3 const& bounds);

/// Snapshots of a process, and their list for viewers.
class snapshot_series {
public:
    /// `process` names the files: snapshots/PROCESS_00000010.vtp.
    explicit snapshot_series(std::string process) : process_(std::move(process)) {}

    /// Those that an interrupted run left, before iteration `until`.
    void recall(output_folder const& out, std::uint64_t every, std::uint64_t until);
    void write(output_folder const& out, std::uint64_t iteration, surface_mesh const& surface);
    /// The same of what is written by others. \returns  its name, without an ending
    std::string add(std::uint64_t iteration);
    /// snapshots/PROCESS.pvd.
    void finish(output_folder const& out) const;

private:
    std::string process_;
    std::vector<tafoni::pvd_entry> series_{};
};

/// Rows of numbers under a heading; those of a run that is gone on with come first.
class history_table {
public:
    explicit history_table(std::string heading) : heading_(std::move(heading)) {}

    void recall(output_folder const& out, std::uint64_t until);
    /// Iterations that rows are of: each at first, then 16 to 32 in a doubling, wherever a run ends or is resumed.
    [[nodiscard]] static bool has_row(std::uint64_t iteration) { return iteration % spacing(iteration) == 0; }
    [[nodiscard]] static std::uint64_t next_row(std::uint64_t iteration) { return (iteration / spacing(iteration) + 1) * spacing(iteration); }
    void add(std::string row);  ///< equal rows in a row count once
    void write(output_folder const& out) const;

private:
    [[nodiscard]] static std::uint64_t spacing(std::uint64_t iteration) { return std::bit_floor(std::max<std::uint64_t>(iteration, 32)) / 16; }

    std::string heading_;
    std::vector<std::string> rows_{};
};

nlohmann::ordered_json json_of(tafoni::vec3 const& v);
/// Counts and box of the input.
nlohmann::ordered_json json_of(mesh_input const& input);

/// Numbers as the shortest text that reads back to the same.
std::string text_of(double v);

}  // namespace weather
