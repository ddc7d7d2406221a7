// One run of `weather hydraulic`, from the input to the report.
#pragma once

#include "hydraulic_command.hpp"
#include "mesh_choice.hpp"
#include "mesh_output.hpp"
#include "notes.hpp"
#include "progress.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/field/any_field.hpp>
#include <tafoni/fluid/emitter.hpp>
#include <tafoni/weathering/hydraulic_erosion.hpp>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace weather {

/// Names for --fluid.
std::vector<std::string> hydraulic_fluids();

class hydraulic_session {
public:
    explicit hydraulic_session(hydraulic_arguments const& a);
    /// False when Ctrl-C ended it early.
    bool run();

private:
    /// What the options and the model's size come to.
    struct water_settings {
        tafoni::vec3 up{0, 0, 1};
        tafoni::vec3 gravity{0, 0, -10};
        tafoni::box_emitter emitter{};
        tafoni::box_sink sink{};
        double radius = 1;
        double friction = 1;
        double lifetime = 1;
        double frame = 0;  ///< s that an iteration takes; 0: one stable step
        double adhesion = 0.8;
        double largest_step = 1;
        double viscosity = 0;
        double sound_speed = 0;  ///< 0: by gravity and the emitter
        std::string k;
        std::string tau_c;
        double influence = 0;
        double step = 10;
    };
    struct field_set {
        tafoni::any_field k, tau_c, a, K, m, durability;
    };

    [[nodiscard]] tafoni::vec3 up() const;
    [[nodiscard]] field_set make_fields(tafoni::box3 const& bounds, water_settings const& w) const;
    void settle();  ///< fills `water_`
    template <class Process>
    void run_process(Process const& process);
    template <class Run>
    void run_with(Run& run);
    template <class Run>
    void weather(Run& run);
    template <class Run>
    [[nodiscard]] surface_mesh surface(Run const& run) const;
    template <class Run>
    void write_checkpoint(Run const& run, std::string const& path) const;
    /// The particles as points with their velocities.
    template <class Run>
    void write_water(Run const& run, std::string const& name) const;
    template <class Run>
    void add_history(Run& run);
    template <class Run>
    void write_report(Run const& run, cut_counts const& cuts) const;

    hydraulic_arguments a_;
    progress progress_;
    tafoni::thread_pool threads_;
    output_folder out_;
    mesh_input input_;
    water_settings water_;
    any_estimator estimator_;
    nlohmann::ordered_json seconds_;
    double aside_ = 0;  ///< seconds within the run that were not the run's
    snapshot_series series_{"hydraulic"};
    snapshot_series water_series_{"water"};
    history_table history_{"iterations,time,vertices,contacts,eroded,deposited,carried,left"};
    unused_options unused_;
    bool stopped_ = false;
};

}  // namespace weather
