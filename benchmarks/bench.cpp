// Times every job, ours beside the peers': CSV on standard output.
//   arm3r_benchmarks                      batches of all in turn
//   arm3r_benchmarks --only NUMBER TIMES  one contender's job so many times and nothing else, for an instruction counter
//   arm3r_benchmarks --list               NUMBER, job and who of each

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>

#include "contender.hpp"

namespace {

using namespace bench;
using Clock = std::chrono::steady_clock;

constexpr int rounds = 400, warm_up_rounds = 20;
constexpr double batch_ns = 5e5;  // short beside a time slice: most batches run undisturbed

double nanoseconds(const Work& work, int times) {
    const Clock::time_point begin = Clock::now();
    work(times);
    return std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
}

class Race {
public:
    explicit Race(const Contender& contender) : contender_(contender), work_(contender.prepare()) {
        while (least_of_three() < batch_ns) times_ *= 2;
    }

    void run_batch() { work_(times_); }
    void time_batch() { each_ns_.push_back(nanoseconds(work_, times_) / times_); }
    const Contender& contender() const { return contender_; }
    double least() const { return *std::min_element(each_ns_.begin(), each_ns_.end()); }

    double median() {
        const auto middle = each_ns_.begin() + static_cast<std::ptrdiff_t>(each_ns_.size() / 2);
        std::nth_element(each_ns_.begin(), middle, each_ns_.end());
        return *middle;
    }

private:
    // An interruption makes a short batch look long.
    double least_of_three() const {
        double least = nanoseconds(work_, times_);
        for (int again = 1; again < 3; ++again) least = std::min(least, nanoseconds(work_, times_));
        return least;
    }

    const Contender& contender_;
    Work work_;
    int times_ = 1;
    std::vector<double> each_ns_;
};

std::string cpu() {
    std::ifstream about("/proc/cpuinfo");
    const std::string key = "model name\t: ";
    for (std::string line; std::getline(about, line);)
        if (line.starts_with(key)) return line.substr(key.size());
    return "unknown";
}

void print_row(const Contender& contender, const std::string& numbers) {
    std::printf("\"%s\",\"%s\",,%s,,\"%s\",\"%s\"\n", contender.job.c_str(), contender.who.c_str(), numbers.c_str(),
                cpu().c_str(), contender.build.c_str());
}

std::string numbers_of(double median, double least, double ratio) {
    char text[100];
    std::snprintf(text, sizeof text, "ns,%.1f,%.1f,%.2f", median, least, ratio);
    return text;
}

// The contenders of one job, taking turns.
void race(const std::vector<const Contender*>& job) {
    std::vector<Race> races;
    for (const Contender* contender : job)
        if (contender->prepare) races.emplace_back(*contender);
        else print_row(*contender, "ns,,,");
    for (int round = -warm_up_rounds; round < rounds; ++round)
        for (Race& one : races) round < 0 ? one.run_batch() : one.time_batch();
    const double ours = races.front().median();
    for (Race& one : races) print_row(one.contender(), numbers_of(one.median(), one.least(), one.median() / ours));
    std::fflush(stdout);
}

void race_all(const std::vector<Contender>& all) {
    check_agreement();
    std::puts("job,who,setting,unit,median,min,times_ours,error,cpu,build");
    for (std::size_t i = 0; i < all.size();) {
        std::vector<const Contender*> job;
        for (const std::string& name = all[i].job; i < all.size() && all[i].job == name; ++i) job.push_back(&all[i]);
        race(job);
    }
}

void list(const std::vector<Contender>& all) {
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].prepare) std::printf("%zu,\"%s\",\"%s\"\n", i, all[i].job.c_str(), all[i].who.c_str());
}

int usage() {
    std::fputs("usage: arm3r_benchmarks [--list | --only NUMBER TIMES]\n", stderr);
    return 2;
}

}  // namespace

int main(int count, char** words) try {
    const std::vector<Contender> all = contenders();
    if (count == 1) race_all(all);
    else if (count == 2 && std::strcmp(words[1], "--list") == 0) list(all);
    else if (count == 4 && std::strcmp(words[1], "--only") == 0)
        all.at(std::strtoul(words[2], nullptr, 10)).prepare()(std::atoi(words[3]));
    else return usage();
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "arm3r_benchmarks: %s\n", error.what());
    return 1;
}
