#include "cli/terminal.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include "cli/arguments.hpp"
#include "platform/files.hpp"
#include "platform/program.hpp"

namespace cli {

namespace platform = arm3r::platform;

namespace {

constexpr int standard_output = 1, standard_error = 2;

volatile std::int32_t stop = 0;
volatile std::sig_atomic_t caught = 0;

void on_signal(int number) {
    caught = number;
    stop = 1;
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

void catch_signals() { platform::catch_end_requests(on_signal); }

const volatile std::int32_t* stop_flag() { return &stop; }

bool stop_requested() { return stop != 0; }

void die_by_signal() { platform::die_of(caught); }

void print(std::string_view text) {
    while (!text.empty()) {
        const std::ptrdiff_t size = platform::write_some(standard_output, text.data(), text.size());
        if (size < 0 && errno == EINTR && !stop_requested()) continue;
        if (size < 0)
            throw Exit{exit_output, "arm3r: error[output]: standard output: " + std::string(std::strerror(errno))};
        text.remove_prefix(static_cast<std::size_t>(size));
    }
}

void complain(std::string_view text) {
    while (!text.empty()) {
        const std::ptrdiff_t size = platform::write_some(standard_error, text.data(), text.size());
        if (size <= 0) return;
        text.remove_prefix(static_cast<std::size_t>(size));
    }
}

Progress::Progress(std::string name)
    : name_(name.substr(0, 30)), start_(now()), next_(start_ + 1), terminal_(platform::is_terminal(standard_error)) {}

Progress::~Progress() {
    if (drawn_) complain("\r\x1b[K");
}

std::int32_t Progress::callback(void* self, double t, double stop_time, std::int64_t) {
    auto& progress = *static_cast<Progress*>(self);
    const double time = now();
    if (!(progress.from_ <= t)) progress.from_ = t;
    if (!progress.terminal_ || time < progress.next_) return 0;
    progress.next_ = time + 0.1;
    const double whole = stop_time - progress.from_;
    progress.draw(time - progress.start_, whole > 0 ? (t - progress.from_) / whole : 1);
    return 0;
}

void Progress::draw(double seconds, double fraction) {
    constexpr int width = 30;
    const int done = std::clamp(static_cast<int>(fraction * width), 0, width);
    const std::string bar =
        std::string(static_cast<std::size_t>(done), '#') + std::string(static_cast<std::size_t>(width - done), '.');
    complain("\r" + name_ + " [" + bar + "] " + std::to_string(static_cast<int>(fraction * 100)) + " %  " +
             std::to_string(static_cast<int>(seconds)) + " s\x1b[K");
    drawn_ = true;
}

}  // namespace cli
