// One run of `weather voxel`, from the input to the report.
#pragma once

#include "output.hpp"
#include "progress.hpp"
#include "voxel_command.hpp"
#include "voxel_durability.hpp"
#include "voxel_input.hpp"
#include "voxel_rules.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/fallen_block.hpp>
#include <tafoni/weathering/voxel_run.hpp>

#include <nlohmann/json.hpp>

namespace weather {

class voxel_session {
public:
    explicit voxel_session(voxel_arguments const& a);
    /// False when Ctrl-C ended it early.
    bool run();

private:
    using process = tafoni::voxel_weathering<any_bubbles, any_rate, any_field>;
    using run_type = tafoni::voxel_run<process>;

    [[nodiscard]] process make_process(voxel_source const& source) const;
    [[nodiscard]] tafoni::voxel_options make_options(voxel_source const& source);
    void resume(run_type& run);
    void recall(run_type const& run);    ///< history and series of the run that is gone on with
    void weather(run_type& run);
    [[nodiscard]] surface_mesh surface(run_type const& run);
    void write_snapshot(run_type const& run);
    void add_history(run_type const& run);
    void write_history() const;
    void write_checkpoint(run_type const& run, std::string const& path) const;
    void write_results(run_type const& run);
    void write_blocks(run_type const& run);
    void write_report(run_type const& run);

    voxel_arguments a_;
    progress progress_;
    std::vector<tafoni::voxel_phase> phases_;
    std::uint64_t steps_ = 0;
    tafoni::thread_pool threads_;
    output_folder out_;
    std::string border_;
    tafoni::vec3 up_{0, 0, 1};
    tafoni::box3 bounds_;
    nlohmann::ordered_json repaired_;
    nlohmann::ordered_json seconds_;
    double surface_seconds_ = 0;
    double snapshot_seconds_ = 0;
    std::size_t joints_ = 0;
    std::vector<std::string> history_;
    std::vector<tafoni::pvd_entry> series_;
    bool stopped_ = false;
};

}  // namespace weather
