// One run of `weather curvature`, from the input to the report.
#pragma once

#include "curvature_command.hpp"
#include "mesh_choice.hpp"
#include "mesh_output.hpp"
#include "notes.hpp"
#include "progress.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/field/any_field.hpp>
#include <tafoni/weathering/curvature_run.hpp>

#include <nlohmann/json.hpp>

namespace weather {

class curvature_session {
public:
    explicit curvature_session(curvature_arguments const& a);
    /// False when Ctrl-C ended it early.
    bool run();

private:
    /// With the direction that was chosen.
    template <class Direction>
    void run_with(Direction direction);
    template <class Run>
    void weather(Run& run);
    template <class Run>
    [[nodiscard]] surface_mesh surface(Run& run);
    template <class Run>
    void add_history(Run& run);
    template <class Run>
    void write_checkpoint(Run const& run, std::string const& path) const;
    template <class Run>
    void write_results(Run& run);
    template <class Run>
    void write_report(Run& run, cut_counts const& cuts) const;

    curvature_arguments a_;
    progress progress_;
    tafoni::thread_pool threads_;
    output_folder out_;
    mesh_input input_;
    tafoni::any_field durability_;
    nlohmann::ordered_json seconds_;
    double aside_ = 0;  ///< seconds within the run that were not the run's
    snapshot_series series_{"curvature"};
    history_table history_{"iterations,vertices,faces,edges_collapsed,volume"};
    unused_options unused_;
    bool stopped_ = false;
};

}  // namespace weather
