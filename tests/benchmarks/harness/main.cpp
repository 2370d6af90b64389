/* The engine without YADE: runs a scene of a file and prints how fast, for profilers and machines with many processors. See usage below. */
#include "run.hpp"
#include <chrono>
#include <cstdio>
#include <cstring>
#include <map>
#include <sstream>

namespace {

constexpr const char* usage = R"(build/harness SCENE [name=value ...]

Runs a scene of a file (tests/benchmarks/scene_file.py) in the fused engine, without YADE, and prints a line of JSON for each measurement and one
for the end, whose hash is of all bits of the grains' motion: equal hashes are equal results.

  steps=500       small steps of one measurement
  threads=1       threads, or several by turns: threads=1,2
  domains=0       parts that the grains are divided into; 0: by their number
  instructions=   avx512, avx2, portable; empty: the best that this machine has
  together=50     small steps in one call of the engine, as subSteps of JKRWadaEngine
  out=            file for the scene at the end
)";

using Settings = std::map<std::string, std::string>;

// Whole numbers of a parameter, divided by commas.
std::vector<long> numbers(const Settings& settings, const std::string& name, long least = 1)
{
	std::vector<long> found;
	std::istringstream parts(settings.at(name) + ',');
	for (std::string part; std::getline(parts, part, ',');) {
		std::istringstream digits(part);
		long number = 0;
		if (!(digits >> number && digits.eof()) || number < least || number > 1000000000)
			throw std::invalid_argument(name + " = " + part + ": must be a whole number of at least " + std::to_string(least));
		found.push_back(number);
	}
	return found;
}

Settings settingsOf(int count, char** arguments)
{
	Settings settings { { "scene", "" }, { "steps", "500" }, { "threads", "1" }, { "domains", "0" }, { "instructions", "" },
		{ "together", "50" }, { "out", "" } };
	for (int k = 1; k < count; ++k) {
		const std::string argument = k == 1 ? "scene=" + std::string(arguments[k]) : arguments[k];
		const std::size_t equals = argument.find('=');
		if (equals == std::string::npos || !settings.count(argument.substr(0, equals)))
			throw std::invalid_argument(argument + ": no such parameter; build/harness --help lists them");
		settings[argument.substr(0, equals)] = argument.substr(equals + 1);
	}
	if (settings["scene"].empty()) throw std::invalid_argument("no scene: must be given first; build/harness --help says more");
	return settings;
}

void measure(harness::Run& run, long steps, long together)
{
	contact_law::Dynamics& dynamics = run.dynamics();
	const double contacts = contact_law::contactCount(dynamics);
	const auto start = std::chrono::steady_clock::now();
	run.run(steps, together);
	const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	const double mean = 0.5 * (contacts + contact_law::contactCount(dynamics));
	std::printf("{\"threads\": %d, \"steps\": %ld, \"msPerStep\": %.6g, \"contacts\": %.1f, \"contactUpdatesPerSecond\": %.5g}\n",
	        dynamics.threadCount(), steps, 1e3 * seconds / double(steps), mean, mean * double(steps) / seconds);
	std::fflush(stdout);
}

void runScene(const Settings& settings)
{
	const long steps = numbers(settings, "steps")[0], together = numbers(settings, "together")[0];
	const std::vector<long> threads = numbers(settings, "threads");
	const int domains = int(numbers(settings, "domains", 0)[0]);
	harness::Run run(harness::readScene(settings.at("scene")), domains, int(threads[0]), settings.at("instructions"));
	const double energy = run.totalEnergy(), kinetic = run.kineticEnergy();
	for (const long each : threads) {
		run.dynamics().setThreads(int(each));
		measure(run, steps, together);
	}
	const harness::Scene end = run.sceneNow();
	if (const std::string& out = settings.at("out"); !out.empty()) harness::writeScene(out, end);
	std::printf("{\"grains\": %zu, \"contacts\": %zu, \"time\": %.9g, \"energyChange\": %.6g, \"kinetic\": %.6g, \"instructions\": "
	            "\"%s\", \"domains\": %zu, \"hash\": \"%016llx\"}\n",
	        end.grains.size(), end.contacts.size(), end.head.time, run.totalEnergy() - energy, kinetic,
	        run.dynamics().state().passes->name, run.dynamics().parts().size(), static_cast<unsigned long long>(run.hash()));
}

} // namespace

int main(int count, char** arguments)
{
	if (count > 1 && !std::strcmp(arguments[1], "--help")) return std::fputs(usage, stdout) < 0;
	try {
		runScene(settingsOf(count, arguments));
	} catch (const std::exception& error) {
		std::fprintf(stderr, "harness: %s\n", error.what());
		return 1;
	}
	return 0;
}
