#pragma once
// Signals, standard output and the terminal of the executable.

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace cli {

// After this call SIGINT, SIGTERM and SIGHUP request the run to stop; a second signal ends the program at once.
void catch_signals();
const volatile std::int32_t* stop_flag();
bool stop_requested();
[[noreturn]] void die_by_signal();

// Writes all of the text, or throws Exit. Errors on standard error are ignored.
void print(std::string_view text);
void complain(std::string_view text);

// A bar on standard error, from one second on, where that is a terminal.
class Progress {
public:
    explicit Progress(std::string name);
    ~Progress();
    static std::int32_t callback(void* self, double t, double stop, std::int64_t steps);

private:
    void draw(double seconds, double fraction);

    std::string name_;
    double start_, next_;                                    // s, monotonic
    double from_ = std::numeric_limits<double>::infinity();  // s, the first simulated time that was reported
    bool terminal_, drawn_ = false;
};

}  // namespace cli
