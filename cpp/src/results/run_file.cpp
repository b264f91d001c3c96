#include "results/run_file.hpp"

#include <algorithm>
#include <array>
#include <future>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "files/output_file.hpp"
#include "platform/threads.hpp"
#include "results/csv.hpp"
#include "results/npz.hpp"

namespace arm3r {
namespace {

using Summary = std::function<std::string_view()>;
using Sink = std::function<void(std::string_view)>;

struct Format {
    std::string_view ending;
    void (*write)(const Run& run, const Summary& summary, const Sink& sink);
};

constexpr std::array formats = std::to_array<Format>({
    {".csv", [](const Run& run, const Summary&,
                const Sink& sink) { write_csv(run, [&](std::string_view piece) { return sink(piece), true; }); }},
    {".npz", write_npz},
});

// Below this many numbers their hash is computed sooner than a thread is started.
constexpr std::size_t worth_a_thread = 1 << 15;

// A file with another ending would not be what its name says.
const Format& format_of(const std::string& path) {
    check_target(path);
    const std::string ending = ending_of(path);
    const auto found = std::ranges::find(formats, ending, &Format::ending);
    if (found != formats.end()) return *found;
    std::vector<std::string> written;
    for (const Format& format : formats) written.emplace_back(format.ending);
    throw Error(ARM3R_E_VALUE, {{.code = "usage",
                                 .message = ending.empty() ? "a run is written by the ending of its file's name"
                                                           : "a run is not written as " + visible(ending),
                                 .got = ending.empty() ? "no ending" : "",
                                 .allowed = listed(written),
                                 .hint = "`-o -` prints CSV, and a name that ends in / is a directory",
                                 .file = path}});
}

}  // namespace

std::string summary_path(const std::string& path) {
    return path.substr(0, path.size() - ending_of(path).size()) + ".json";
}

// The hash of the summary takes about as long as the rows: another thread computes it, if there can be one.
void save_run(const Run& run, const std::function<const char*()>& summary, const std::string& path) {
    const Format& format = format_of(path);
    OutputFile rows(path), beside(summary_path(path));
    const bool is_long = run.rows * run.columns.size() > worth_a_thread;
    const auto policy =
        platform::has_threads && is_long ? std::launch::async | std::launch::deferred : std::launch::deferred;
    std::future<const char*> text = std::async(policy, summary);
    format.write(run, [&] { return std::string_view(text.get()); }, [&](std::string_view piece) { rows.write(piece); });
    beside.write(summary());
    rows.close();
    beside.close();
    rows.publish();
    beside.publish();
}

void probe_run_file(const std::string& path) {
    format_of(path);
    OutputFile{path};
    OutputFile{summary_path(path)};
}

}  // namespace arm3r
