/* The engine without YADE: runs a scene of a file and says how fast, for profilers and for machines with many processors. See usage below. */
#include "run.hpp"
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace {

constexpr const char* usage = R"(build/harness SCENE [name=value ...]

Runs a scene of a file (tests/benchmarks/scene_file.py) in the fused engine, without YADE, and prints a line of JSON for each measurement and one
for the end, whose hash is of all bits of the grains' motion: equal hashes are equal results.

  steps=500       small steps of one measurement
  threads=1       threads, or several by turns: threads=1,2
  rounds=1        measurements with each
  domains=0       parts that the grains are divided into; 0: by their number
  instructions=   avx512, avx2, portable; empty: the best that this machine has
  together=50     small steps in one call of the engine, as subSteps of JKRWadaEngine
  warm=0          small steps before the first measurement
  out=            file for the scene at the end
  control=        fifo of perf record --delay=-1 --control fifo:NAME, which then samples the measurements only
)";

struct Settings {
	std::string scene;
	std::vector<long> threads { 1 };
	std::map<std::string, long> numbers { { "steps", 500 }, { "rounds", 1 }, { "domains", 0 }, { "together", 50 }, { "warm", 0 } };
	std::map<std::string, std::string> words { { "instructions", "" }, { "out", "" }, { "control", "" } };
	long operator[](const char* name) const { return numbers.at(name); }
};

long wholeNumber(const std::string& name, const std::string& text, long least)
{
	std::size_t used = 0;
	long number = least - 1;
	try {
		number = std::stol(text, &used);
	} catch (const std::exception&) {
	}
	if (used != text.size() || text.empty() || number < least || number > 1000000000)
		throw std::invalid_argument(name + " = " + text + ": must be a whole number of at least " + std::to_string(least));
	return number;
}

void take(Settings& settings, const std::string& argument)
{
	const std::size_t equals = argument.find('=');
	const std::string name = argument.substr(0, equals), value = equals == std::string::npos ? "" : argument.substr(equals + 1);
	if (equals == std::string::npos && settings.scene.empty())
		settings.scene = argument;
	else if (settings.numbers.count(name))
		settings.numbers[name] = wholeNumber(name, value, name == "domains" || name == "warm" ? 0 : 1);
	else if (settings.words.count(name))
		settings.words[name] = value;
	else if (name == "threads") {
		settings.threads.clear();
		std::istringstream parts(value + ',');
		for (std::string part; std::getline(parts, part, ',');)
			settings.threads.push_back(wholeNumber(name, part, 1));
	} else
		throw std::invalid_argument(argument + ": no such parameter; build/harness --help lists them");
}

struct Counted { // since the start
	contact_law::Dynamics::Counters counters;
	contact_law::Counts counts;
	explicit Counted(const contact_law::Dynamics& dynamics)
	        : counters(dynamics.counters())
	        , counts(contact_law::counts(dynamics))
	{
	}
};

// Tells perf to begin or to end sampling.
void tell(const Settings& settings, const char* command)
{
	const std::string& path = settings.words.at("control");
	if (path.empty()) return;
	std::ofstream control(path);
	control << command << std::endl;
	if (!control) throw std::runtime_error(path + ": must be a fifo that perf reads");
}

void measure(harness::Run& run, const Settings& settings, long threads)
{
	contact_law::Dynamics& dynamics = run.dynamics();
	dynamics.setThreads(int(threads));
	const Counted before(dynamics);
	const double contacts = contact_law::contactCount(dynamics);
	tell(settings, "enable");
	const auto start = std::chrono::steady_clock::now();
	run.run(settings["steps"], settings["together"]);
	const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	tell(settings, "disable");
	const Counted after(dynamics);
	const double mean = 0.5 * (contacts + contact_law::contactCount(dynamics));
	std::printf("{\"threads\": %d, \"steps\": %ld, \"msPerStep\": %.6g, \"contacts\": %.1f, \"contactUpdatesPerSecond\": %.5g, "
	            "\"searches\": %.4g, \"distanceChecks\": %ld, \"events\": %ld, \"formed\": %ld, \"broken\": %ld}\n",
	        dynamics.threadCount(), settings["steps"], 1e3 * seconds / double(settings["steps"]), mean,
	        mean * double(settings["steps"]) / seconds, after.counters.searches - before.counters.searches,
	        after.counters.distanceChecks - before.counters.distanceChecks, after.counts.events - before.counts.events,
	        after.counts.formed - before.counts.formed, after.counts.broken - before.counts.broken);
	std::fflush(stdout);
}

void runScene(const Settings& settings)
{
	if (settings.scene.empty()) throw std::invalid_argument("no scene: must be given first; build/harness --help says more");
	harness::Run run(
	        harness::readScene(settings.scene), int(settings["domains"]), int(settings.threads[0]), settings.words.at("instructions"));
	const double energy = run.totalEnergy(), kinetic = run.kineticEnergy();
	run.run(settings["warm"], settings["together"]);
	for (long round = 0; round < settings["rounds"]; ++round)
		for (const long threads : settings.threads)
			measure(run, settings, threads);
	const harness::Scene end = run.sceneNow();
	if (const std::string& out = settings.words.at("out"); !out.empty()) harness::writeScene(out, end);
	std::printf("{\"grains\": %zu, \"contacts\": %zu, \"time\": %.9g, \"energyChange\": %.6g, \"kinetic\": %.6g, \"instructions\": "
	            "\"%s\", \"domains\": %zu, "
	            "\"hash\": \"%016llx\"}\n",
	        end.grains.size(), end.contacts.size(), end.head.time, run.totalEnergy() - energy, kinetic,
	        run.dynamics().state().passes->name, run.dynamics().parts().size(), static_cast<unsigned long long>(run.hash()));
}

} // namespace

int main(int count, char** arguments)
{
	try {
		Settings settings;
		for (int k = 1; k < count; ++k) {
			if (!std::strcmp(arguments[k], "--help") || !std::strcmp(arguments[k], "-h")) return std::fputs(usage, stdout) < 0;
			take(settings, arguments[k]);
		}
		runScene(settings);
	} catch (const std::exception& error) {
		std::fprintf(stderr, "harness: %s\n", error.what());
		return 1;
	}
	return 0;
}
