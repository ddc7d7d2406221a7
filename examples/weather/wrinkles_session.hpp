// One run of `weather wrinkles`, from the input to the report.
#pragma once

#include "mesh_output.hpp"
#include "notes.hpp"
#include "progress.hpp"
#include "wrinkles_command.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/weathering/wrinkles.hpp>

#include <nlohmann/json.hpp>

#include <vector>

namespace weather {

class wrinkles_session {
public:
    explicit wrinkles_session(wrinkles_arguments const& a);
    /// False when Ctrl-C ended it early.
    bool run();

private:
    [[nodiscard]] std::vector<tafoni::wrinkle> wrinkles(mesh_input const& input) const;
    [[nodiscard]] std::vector<tafoni::enlargement> enlargements() const;
    /// With numbers per vertex; `flat` is the surface before.
    [[nodiscard]] surface_mesh worn(tafoni::wrinkle_pattern const& pattern, tafoni::triangle_surface const& flat, tafoni::triangle_surface const& now) const;
    void make_folder(mesh_input const& input);
    /// Wears the pattern until it has been --times.
    void weather(tafoni::wrinkle_pattern const& pattern, tafoni::triangle_surface const& flat, tafoni::triangle_surface& now);
    void write_checkpoint(tafoni::triangle_surface const& now, std::string const& path) const;
    void resume(tafoni::triangle_surface& now);
    void write_report(mesh_input const& input, tafoni::wrinkle_pattern const& pattern, double volume, cut_counts const& cuts) const;

    wrinkles_arguments a_;
    progress progress_;
    tafoni::thread_pool threads_;
    output_folder out_;
    nlohmann::ordered_json seconds_;
    snapshot_series series_{"wrinkles"};
    std::uint64_t hash_ = 0;  ///< of the surface and what is worn
    std::uint32_t done_ = 0;  ///< times
    double aside_ = 0;        ///< seconds within the weathering that were not its own
    unused_options unused_;
    bool stopped_ = false;
};

}  // namespace weather
