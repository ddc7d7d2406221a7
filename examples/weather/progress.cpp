#include "progress.hpp"

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace weather {

namespace {

volatile std::sig_atomic_t interrupt_seen = 0;

extern "C" void on_interrupt(int) {
    interrupt_seen = 1;
    std::signal(SIGINT, SIG_DFL);
}

}  // namespace

progress_style progress_style_of(std::string const& name) {
    if (name == "json") return progress_style::json;
    if (name == "bar") return progress_style::bar;
    if (name == "auto") return ::isatty(2) != 0 ? progress_style::bar : progress_style::none;
    return progress_style::none;
}

void catch_interrupt() { std::signal(SIGINT, on_interrupt); }
bool interrupted() { return interrupt_seen != 0; }

progress::~progress() {
    if (open_line_) std::fputc('\n', stderr);
}

tafoni::step_control progress::show(std::string_view stage, double fraction, std::string const& note) {
    // A reader of lines wants each stage's start, its end, and about a hundred steps between.
    int const percentage = static_cast<int>(fraction * 100);
    if (style_ == progress_style::json && (stage != last_stage_ || percentage != last_percentage_)) {
        last_stage_ = stage;
        last_percentage_ = percentage;
        nlohmann::ordered_json line{{"stage", stage}, {"fraction", fraction}};
        if (!note.empty()) line["note"] = note;
        std::fprintf(stderr, "%s\n", line.dump().c_str());
    }
    if (style_ == progress_style::bar) {
        int const width = 30;
        int const full = static_cast<int>(fraction * width);
        char percent[8];
        std::snprintf(percent, sizeof percent, "%3d %%", static_cast<int>(fraction * 100));
        std::string line(1, '[');
        line.append(static_cast<std::size_t>(full), '#').append(static_cast<std::size_t>(width - full), ' ');
        line.append("] ").append(percent).append("  ").append(stage);
        if (!note.empty()) line.append("  ").append(note);
        if (line != last_line_) {
            std::fprintf(stderr, "\r%s\033[K", line.c_str());
            last_line_ = std::move(line);
            open_line_ = true;
            if (fraction >= 1) {
                std::fputc('\n', stderr);
                open_line_ = false;
            }
        }
    }
    return interrupted() ? tafoni::step_control::stop : tafoni::step_control::proceed;
}

tafoni::run_context progress::context() {
    return {.on_progress = [this](tafoni::progress_event const& e) { return show(e.stage, e.fraction); }};
}

}  // namespace weather
