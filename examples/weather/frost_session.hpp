// One run of `weather frost`, from the input to the report.
#pragma once

#include "frost_command.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "resistance.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/percolation/cone_rain.hpp>
#include <tafoni/weathering/frost_presets.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <nlohmann/json.hpp>

namespace weather {

class frost_session {
public:
    explicit frost_session(frost_arguments const& a);
    /// False when Ctrl-C ended it early.
    bool run();

private:
    using process = tafoni::frost_wedging<tafoni::rainfall<tafoni::cone_rain>,
                                          tafoni::seepage<tafoni::gravity_flow, any_field>>;
    using run_type = tafoni::frost_run<tafoni::link_graph, process>;

    void prepare();               ///< input, sites, shards, graphs
    [[nodiscard]] process make_process() const;
    void mark(run_type& run);
    void resume(run_type& run);
    void weather(run_type& run);
    [[nodiscard]] tafoni::shard_surface roughened(tafoni::shard_surface surface) const;
    [[nodiscard]] surface_mesh standing(run_type const& run) const;
    void write_snapshot(run_type const& run);
    void write_history() const;
    void write_checkpoint(run_type const& run, std::string const& path) const;
    void write_results(run_type const& run);
    void write_blocks(run_type const& run);
    void write_graphs(run_type const& run) const;
    void add_history(run_type const& run);
    void write_report(run_type const& run);
    [[nodiscard]] surface_colours colours(run_type const& run) const;

    frost_arguments a_;
    progress progress_;
    tafoni::vec3 gravity_;
    tafoni::vec3 up_;
    tafoni::frost_preset preset_;
    tafoni::solid body_;
    bool terrain_ = false;
    tafoni::shard_complex shards_;
    tafoni::link_graph links_;
    std::size_t site_count_ = 0;
    std::size_t core_cells_ = 0;
    std::size_t air_cells_ = 0;
    output_folder out_;
    std::vector<std::string> history_;
    std::vector<tafoni::pvd_entry> series_;
    nlohmann::ordered_json repaired_;
    nlohmann::ordered_json seconds_;
    tafoni::vec3 rain_;
    bool stopped_ = false;
};

}  // namespace weather
