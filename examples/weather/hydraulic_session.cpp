#include "hydraulic_session.hpp"

#include "field_choice.hpp"
#include "input.hpp"
#include "notes.hpp"
#include "spec.hpp"

#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/fluid/sph.hpp>
#include <tafoni/io/hydraulic_channels.hpp>
#include <tafoni/io/write_vtp.hpp>
#include <tafoni/version.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <utility>
#include <span>

namespace weather {

using namespace tafoni;

namespace {

/// `x0,y0,z0,x1,y1,z1`.
box3 parse_box(std::string const& option, std::string const& text) {
    if (std::count(text.begin(), text.end(), ',') != 5) throw usage_error(option + " " + text + ": six numbers x0,y0,z0,x1,y1,z1 are needed");
    std::size_t comma = 0;
    for (int n = 0; n < 3 && comma != std::string::npos; ++n) comma = text.find(',', comma + (n > 0 ? 1 : 0));
    box3 out{.lo = parse_vector(option, text.substr(0, comma)), .hi = parse_vector(option, text.substr(comma + 1))};
    for (int d = 0; d < 3; ++d) {
        if (!(out.lo[d] <= out.hi[d])) throw usage_error(option + " " + text + ": the box is empty");
    }
    return out;
}

/// As many layers of places a spacing apart, from the rock up, as so many particles need, and no wider than 2^22 places.
box3 with_room_for(double particles, double spacing, box3 box, int axis, bool rises) {
    auto const places = [&](int d) { return std::floor((box.hi[d] - box.lo[d]) / spacing) + 1; };
    double layer = 1;
    for (int d = 0; d < 3; ++d) {
        if (d != axis) layer *= places(d);
    }
    double const most = 4194304;
    if (layer > most) {
        for (int d = 0; d < 3; ++d) {
            if (d == axis) continue;
            double const cut = 0.5 * (box.hi[d] - box.lo[d]) * (1 - std::sqrt(most / layer));
            box.lo[d] += cut;
            box.hi[d] -= cut;
        }
        layer = most;
    }
    double const layers = std::min(places(axis), std::ceil(particles / layer));
    if (rises) {
        box.hi[axis] = std::min(box.hi[axis], box.lo[axis] + spacing * (layers - 1));
    } else {
        box.lo[axis] = std::max(box.lo[axis], box.hi[axis] - spacing * (layers - 1));
    }
    return box;
}

int axis_of(vec3 const& up) {
    int axis = 0;
    for (int d = 1; d < 3; ++d) {
        if (std::fabs(up[d]) > std::fabs(up[axis])) axis = d;
    }
    return axis;
}

/// The erosion of `base`, divided where rock is hard; what is laid down is not.
struct hardened {
    static constexpr char const* name = "partheniades with durability";

    partheniades_erosion base{};
    any_field durability = 1;
    std::array<double, 2> fields{};  ///< what checkpoints know of them

    [[nodiscard]] double rate(wash_point const& at) const {
        double const r = base.rate(at);
        return r > 0 ? r / std::max(durability(at.position), 1e-3) : r;
    }
    void validate() const { base.validate(); }
    [[nodiscard]] std::array<double, 2> parameters() const { return fields; }
    /// O(vertices).
    void look_at_fields(std::span<vec3 const> positions) {
        detail::number_hash h;
        for (any_field const* f : {&base.coefficient, &base.critical, &base.exponent, &base.consistency, &base.power, &durability}) {
            for (vec3 const& p : positions) h.add((*f)(p));
        }
        fields = {static_cast<double>(h.value() >> 32), static_cast<double>(h.value() & 0xFFFFFFFF)};
    }
};
static_assert(exchange_rule<hardened>);

}  // namespace

std::vector<std::string> hydraulic_fluids() { return {"rain", "sph"}; }

hydraulic_session::hydraulic_session(hydraulic_arguments const& a)
    : a_(a), progress_(progress_style_of(a.progress)), threads_(a.threads), out_(a.output, a.formats, vec3{0, 0, 0}),
      estimator_(parse_estimator(a.estimator)) {
    // What cannot be read, or has no effect, is told before the work begins.
    bool const rain = a_.fluid == "rain";
    bool const shear = a_.model == "partheniades";
    static_cast<void>(up());
    static_cast<void>(parse_vector("--velocity", a_.velocity));
    if (!a_.emitter.empty()) static_cast<void>(parse_box("--emitter", a_.emitter));
    water_settings w;
    w.k = a_.k.empty() ? "1" : a_.k;
    w.tau_c = a_.tau_c.empty() ? "1" : a_.tau_c;
    static_cast<void>(make_fields({.lo = {0, 0, 0}, .hi = {1, 1, 1}}, w));
    if (rain) unused_.tell("without --fluid sph", {{"--viscosity", a_.viscosity >= 0}, {"--sound-speed", a_.sound_speed > 0}});
    if (!rain) unused_.tell("without --fluid rain", {{"--lifetime", a_.lifetime > 0}, {"--adhesion", a_.adhesion >= 0}});
    if (shear) unused_.tell("without --model curvature", {{"--influence", a_.influence > 0}, {"--power", a_.power != 1}});
    if (!shear) {
        unused_.tell("without --model partheniades", {{"--k", !a_.k.empty()}, {"--tau-c", !a_.tau_c.empty()}, {"--a", a_.a != "1"}, {"--K", a_.K != "1"}, {"--m", a_.m != "1"}});
    }
    if (!a_.gravity.empty() && length(parse_vector("--gravity", a_.gravity)) > 0) unused_.tell("with --gravity", {{"--up", a_.up != "z"}});
}

/// Against gravity, where it is given.
vec3 hydraulic_session::up() const {
    if (a_.gravity.empty()) return parse_up(a_.up);
    vec3 const g = parse_vector("--gravity", a_.gravity);
    if (!(length(g) > 0)) return parse_up(a_.up);
    return vec3{normalized(g) * -1.0};
}

hydraulic_session::field_set hydraulic_session::make_fields(box3 const& bounds, water_settings const& w) const {
    field_frame const frame{.bounds = bounds, .up = up(), .seed = a_.seed};
    auto const field = [&](char const* option, std::string const& text, double least, double most) {
        return make_field(option, text, least, most, frame);
    };
    return {.k = field("--k", w.k, 0, 1e100), .tau_c = field("--tau-c", w.tau_c, 0, 1e100), .a = field("--a", a_.a, 1e-6, 100),
            .K = field("--K", a_.K, 0, 1e100), .m = field("--m", a_.m, 1e-6, 100),
            .durability = field("--durability", a_.durability, 1e-3, 1e9)};
}

void hydraulic_session::settle() {
    water_settings& w = water_;
    if (a_.particles == 0) a_.particles = static_cast<std::uint32_t>(std::clamp<std::size_t>(input_.surface.positions.size() / 2, 10000, 100000));
    double const size = input_.size;
    double const edge = input_.mean_edge();
    w.up = up();
    w.gravity = a_.gravity.empty() ? vec3{w.up * (-10 * size)} : parse_vector("--gravity", a_.gravity);
    double const g = length(w.gravity) > 0 ? length(w.gravity) : 10 * size;
    double const fall = std::sqrt(size / g);   // s, about as long as a drop falls
    double const speed = std::sqrt(size * g);  // about that at which it lands
    w.radius = a_.radius > 0 ? a_.radius : edge;
    bool const sph = a_.fluid == "sph";
    // A stream a particle deep runs at about the speed of its waves, whatever it came down from, so what is told of it goes by
    // the particles: friction for a Froude number of 4 sin(slope), and stresses of water that thick at that speed.
    double const pace = std::sqrt(g / w.radius);
    double const stress = sph ? pace : speed / edge;  // of rain: of water as thick as an edge at the speed of a fall
    w.friction = a_.friction >= 0 ? a_.friction : sph ? 0.25 * pace : 0.8 / fall;
    w.lifetime = a_.lifetime > 0 ? a_.lifetime : 15 * fall;
    w.adhesion = a_.adhesion >= 0 ? a_.adhesion : 0.8;
    w.largest_step = 0.1 * fall;
    w.viscosity = a_.viscosity >= 0 ? a_.viscosity : 0.02 * speed * w.radius;
    w.tau_c = a_.tau_c.empty() ? text_of((sph ? 0.2 : 0.1) * stress) : a_.tau_c;
    // About an edge in 600 iterations where a stream cuts.
    w.k = a_.k.empty() ? text_of((sph ? 3 * edge : 0.0015 * size) / (fall * stress)) : a_.k;
    w.frame = a_.frame >= 0 ? a_.frame : sph ? 0.005 * fall : 0.0;
    // Where nothing tells how fast water will be, as under the gravity that is the default.
    bool const at_rest = !(length(w.gravity) > 0) && !(length(parse_vector("--velocity", a_.velocity)) > 0);
    w.sound_speed = a_.sound_speed > 0 ? a_.sound_speed : at_rest ? 10 * std::sqrt(2 * g * 16 * w.radius) : 0.0;
    w.influence = a_.influence > 0 ? a_.influence : edge + (sph ? w.radius : 0.0);  // sph rests a radius off the rock
    w.step = a_.step >= 1 ? a_.step : sph ? 100 : 10;
    int const axis = axis_of(w.up);
    bool const rises = w.up[axis] > 0;
    box3 const& b = input_.bounds;
    w.emitter.velocity = parse_vector("--velocity", a_.velocity);
    if (a_.emitter.empty()) {
        box3& box = w.emitter.box;
        for (int d = 0; d < 3; ++d) {
            double const inset = input_.terrain ? 2 * w.radius : 0.15 * b.extent()[d];
            box.lo[d] = std::min(b.lo[d] + inset, 0.5 * (b.lo[d] + b.hi[d]));
            box.hi[d] = std::max(b.hi[d] - inset, 0.5 * (b.lo[d] + b.hi[d]));
        }
        double const near_by = 2 * w.radius;
        double const deep = 0.1 * size;
        box.lo[axis] = rises ? b.hi[axis] + near_by : b.lo[axis] - near_by - deep;
        box.hi[axis] = rises ? b.hi[axis] + near_by + deep : b.lo[axis] - near_by;
        if (sph) w.emitter.box = with_room_for(a_.particles, w.radius, box, axis, rises);
    } else {
        w.emitter.box = parse_box("--emitter", a_.emitter);
    }
    // Water that leaves the model's box sideways or below is gone; above it may splash.
    box3& keep = w.sink.keep;
    keep = b;
    keep.include(w.emitter.box.lo);
    keep.include(w.emitter.box.hi);
    double const around = input_.terrain || input_.open_edges > 0 ? 0.5 * w.radius : 4 * w.radius;
    for (int d = 0; d < 3; ++d) {
        keep.lo[d] -= around + (d == axis && !rises ? 0.2 * size : 0.0);
        keep.hi[d] += around + (d == axis && rises ? 0.2 * size : 0.0);
    }
}

bool hydraulic_session::run() {
    require_makable(a_.output);
    if (!a_.checkpoint.empty()) {
        std::filesystem::path const folder = std::filesystem::path(a_.checkpoint).parent_path();
        require_makable(folder.empty() ? "." : folder.string());
    }
    stopwatch watch;
    progress_.context().tick("read", 0);
    input_ = load_surface(a_.input, a_.seed);
    if (!(input_.size >= 1e-40 && input_.size <= 1e40)) {
        detail::fail<invalid_input>(errc::out_of_range, a_.input + ": the model is " + text_of(input_.size) + " long; water runs over models of 1e-40 to 1e40 only",
                                    {.kind = entity::file, .file = a_.input, .value = input_.size});
    }
    progress_.context().tick("read", 1);
    settle();
    seconds_["read"] = watch.lap();
    field_set const fields = make_fields(input_.bounds, water_);
    if (a_.model == "curvature") {
        run_process(curvature_erosion<any_estimator>{.estimator = estimator_, .power = a_.power, .influence = water_.influence, .durability = fields.durability});
    } else {
        hardened process{.base = {.coefficient = fields.k, .critical = fields.tau_c, .exponent = fields.a, .consistency = fields.K, .power = fields.m},
                         .durability = fields.durability};
        process.look_at_fields(input_.surface.positions);
        run_process(process);
    }
    return !stopped_;
}

template <class Process>
void hydraulic_session::run_process(Process const& process) {
    hydraulic_options const options{.step_divisor = water_.step, .refine_length = a_.refine, .check_every = a_.check_every};
    if (a_.fluid == "sph") {
        sph<float> const water(water_.emitter, water_.sink,
                               {.particles = a_.particles, .spacing = water_.radius, .sound_speed = water_.sound_speed, .viscosity = water_.viscosity, .friction = water_.friction,
                                .gravity = water_.gravity, .largest_step = water_.largest_step, .frame = water_.frame});
        hydraulic_run run(input_.surface, water, process, options);
        run_with(run);
        return;
    }
    rain_particles const rain(water_.emitter, water_.sink,
                              {.particles = a_.particles, .radius = water_.radius, .gravity = water_.gravity, .friction = water_.friction,
                               .adhesion = water_.adhesion, .largest_step = water_.largest_step, .frame = water_.frame, .lifetime = water_.lifetime, .seed = a_.seed});
    hydraulic_run run(input_.surface, rain, process, options);
    run_with(run);
}

template <class Run>
void hydraulic_session::run_with(Run& run) {
    if (!a_.resume.empty()) {
        std::string const bytes = load_bytes(a_.resume);
        auto const refuse = [&]<class E>(E const& e) { detail::fail<E>(e.code(), a_.resume + ": " + e.what(), {.kind = entity::file, .file = a_.resume}); };
        try {
            run.resume(std::as_bytes(std::span(bytes.data(), bytes.size())));
        } catch (io_error const& e) {
            refuse(e);
        } catch (invalid_input const& e) {
            refuse(e);
        }
        if (run.report().iterations > a_.iterations) {
            throw usage_error("--iterations " + std::to_string(a_.iterations) + ": the checkpoint has " +
                              std::to_string(run.report().iterations));
        }
    }
    // Made only now that the input has been accepted, so that a refused run leaves nothing behind.
    std::filesystem::path const folder = made_folder(a_.output);
    vec3 origin{0, 0, 0};
    for (int k = 0; k < 3; ++k) origin[k] = std::floor(input_.bounds.lo[k]);
    out_ = output_folder(folder, a_.formats, origin);
    if (a_.snapshots > 0) made_folder((folder / "snapshots").string());
    std::uint64_t const begin = run.report().iterations;
    out_.remove_old("hydraulic", [&](std::uint64_t n) { return !a_.resume.empty() && n <= begin; });
    out_.remove_old("water", [&](std::uint64_t n) { return a_.particles_out && !a_.resume.empty() && n <= begin; });
    stopwatch watch;
    weather(run);
    seconds_["weather"] = watch.lap() - aside_;
    progress_.show("write", 0);
    add_history(run);
    out_.write("weathered", surface(run));
    history_.write(out_);
    if (a_.particles_out) write_water(run, "water");
    std::string checkpoint = a_.checkpoint;
    if (checkpoint.empty() && stopped_) checkpoint = (out_.folder() / "hydraulic.checkpoint").string();
    if (!checkpoint.empty()) write_checkpoint(run, checkpoint);
    if (stopped_) std::fprintf(stderr, "stopped; go on with --resume %s\n", checkpoint.c_str());
    // Last, so that it names only what is there.
    if (a_.snapshots > 0 && out_.writes("vtp")) series_.finish(out_);
    if (a_.snapshots > 0 && a_.particles_out) water_series_.finish(out_);
    progress_.show("write", 1);
    seconds_["write"] = watch.lap() + aside_;
    cut_counts const cuts = cut_counts::of(input_.surface, run.surface());
    seconds_["check"] = watch.lap();
    write_report(run, cuts);
    hydraulic_report const& r = run.report();
    std::fprintf(stderr, "%s: %llu iterations, %.4g s of flow, %llu contacts, eroded %.4g, deposited %.4g, carried %.4g, left %.4g; worn by up to %.3g mean edges\n", a_.output.c_str(),
                 static_cast<unsigned long long>(r.iterations), r.time, static_cast<unsigned long long>(r.contacts), r.ledger.eroded,
                 r.ledger.deposited, r.ledger.carried, r.ledger.left, run.wear().empty() ? 0.0 : *std::max_element(run.wear().begin(), run.wear().end()) / input_.mean_edge());
    if (r.contacts == 0 && r.iterations > 0) note("no particle touched the mesh; what may help: another --emitter, a larger --radius, more --iterations, the default --gravity or --lifetime");
    if (r.contacts > 0 && r.ledger.eroded == 0) note("the water took no rock; what may help: a lower --tau-c, a larger --k");
    cuts.tell(a_.check_every == 0 ? "--check-every 20 prevents it" : "shorter steps (--step " + text_of(3 * water_.step) + ") may help");
}

template <class Run>
void hydraulic_session::weather(Run& run) {
    std::uint64_t done = run.report().iterations;
    if (!a_.resume.empty()) {
        history_.recall(out_, done);
        series_.recall(out_, a_.snapshots, done);
        if (a_.particles_out) water_series_.recall(out_, a_.snapshots, done);
    }
    run_context const context{.on_progress = [&](progress_event const&) {
        std::uint64_t const n = run.report().iterations;
        double const share = a_.iterations == 0 ? 1 : static_cast<double>(n) / static_cast<double>(a_.iterations);
        return progress_.show("weather", share, std::to_string(n) + " iterations");
    }};
    for (;;) {
        stopwatch watch;
        if (history_table::has_row(done)) {  // the run is cut there, which changes nothing
            static_cast<void>(run.run(0));  // brings the report up to date
            add_history(run);
        }
        if (a_.snapshots > 0 && done % a_.snapshots == 0) {
            series_.write(out_, done, surface(run));
            if (a_.particles_out) write_water(run, water_series_.add(done));
            history_.write(out_);
            if (!a_.checkpoint.empty()) write_checkpoint(run, a_.checkpoint);
        }
        aside_ += watch.lap();
        if (done == a_.iterations) break;
        std::uint64_t next = std::min(a_.iterations, history_table::next_row(done));
        if (a_.snapshots > 0) next = std::min(next, (done / a_.snapshots + 1) * a_.snapshots);
        hydraulic_report const r = run.run(next - done, context, threads_);
        done = r.iterations;
        if (r.stopped == hydraulic_stop::observer) {
            stopped_ = done < a_.iterations;
            break;
        }
    }
}

template <class Run>
void hydraulic_session::write_checkpoint(Run const& run, std::string const& path) const {
    auto const bytes = run.checkpoint();
    detail::write_file("weather", path, {reinterpret_cast<char const*>(bytes.data()), bytes.size()});
}

template <class Run>
surface_mesh hydraulic_session::surface(Run const& run) const {
    return mesh_with(run.surface(), channels_of(run, estimator_, threads_).vertex_channels);
}

template <class Run>
void hydraulic_session::write_water(Run const& run, std::string const& name) const {
    auto const& water = run.fluid();
    polyline_set points;
    std::vector<mesh_channel> channels{vertex_numbers("vx", {}), vertex_numbers("vy", {}), vertex_numbers("vz", {})};
    for (std::size_t i = 0; i < water.particle_count(); ++i) {
        points.positions.push_back(water.position(i));
        vec3 const v = water.velocity(i);
        for (int d = 0; d < 3; ++d) channels[static_cast<std::size_t>(d)].values.push_back(v[d]);
    }
    write_vtp(out_.folder() / (name + ".vtp"), points, channels);
}

template <class Run>
void hydraulic_session::add_history(Run& run) {
    hydraulic_report const& r = run.report();
    std::string row = std::to_string(r.iterations) + "," + text_of(r.time) + "," + std::to_string(run.surface().positions.size()) + "," +
                      std::to_string(r.contacts);
    for (double const v : {r.ledger.eroded, r.ledger.deposited, r.ledger.carried, r.ledger.left}) row += "," + text_of(v);
    history_.add(std::move(row));
}

template <class Run>
void hydraulic_session::write_report(Run const& run, cut_counts const& cuts) const {
    hydraulic_report const& r = run.report();
    water_settings const& w = water_;
    nlohmann::ordered_json j;
    j["schema"] = "tafoni.weather.hydraulic/1";
    j["version"] = version_string;
    j["process"] = "hydraulic";
    j["input"] = a_.input;
    j["seed"] = a_.seed;
    j["parameters"] = {{"model", a_.model}, {"fluid", a_.fluid}, {"iterations", a_.iterations}, {"particles", a_.particles},
                       {"emitter", {{"lo", json_of(w.emitter.box.lo)}, {"hi", json_of(w.emitter.box.hi)}}},
                       {"velocity", json_of(w.emitter.velocity)}, {"gravity", json_of(w.gravity)}, {"radius", w.radius},
                       {"friction", w.friction}, {"lifetime", w.lifetime}, {"adhesion", w.adhesion}, {"frame", w.frame}, {"viscosity", w.viscosity}, {"sound_speed", w.sound_speed}, {"k", w.k}, {"tau_c", w.tau_c},
                       {"a", a_.a}, {"K", a_.K}, {"m", a_.m}, {"influence", w.influence}, {"power", a_.power}, {"estimator", a_.estimator},
                       {"durability", a_.durability}, {"step", w.step}, {"refine", a_.refine}, {"check_every", a_.check_every}, {"snapshots", a_.snapshots},
                       {"format", a_.formats}};
    j["unused"] = unused_.json();
    j["mesh"] = json_of(input_);
    j["bounds"] = {{"lo", json_of(input_.bounds.lo)}, {"hi", json_of(input_.bounds.hi)}};
    j["keep"] = {{"lo", json_of(w.sink.keep.lo)}, {"hi", json_of(w.sink.keep.hi)}};
    j["threads"] = a_.threads;
    j["stopped"] = stopped_ ? "interrupted" : "finished";
    j["repaired"] = input_.repaired;
    j["iterations"] = r.iterations;
    j["time"] = r.time;
    j["particles"] = r.particles;
    j["contacts"] = r.contacts;
    j["vertices"] = run.surface().positions.size();
    j["faces"] = run.surface().triangles.size();
    j["vertices_added"] = r.vertices_added;
    j["ledger"] = {{"eroded", r.ledger.eroded}, {"deposited", r.ledger.deposited}, {"carried", r.ledger.carried}, {"left", r.ledger.left}};
    j["volume_before"] = volume_of(input_.surface, input_.bounds);
    j["volume_after"] = volume_of(run.surface(), input_.bounds);
    j["self_intersections"] = cuts.json();
    auto const wear = run.wear();
    j["largest_wear"] = wear.empty() ? 0.0 : *std::max_element(wear.begin(), wear.end());
    j["seconds"] = seconds_;
    out_.write_text("report.json", j.dump(2) + "\n");
}

}  // namespace weather
