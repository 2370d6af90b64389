/* The engine without YADE: runs a scene of a file and says how fast, for profilers and for machines with many processors. See usage below. */
#include "run.hpp"
#include <chrono>
#include <cstdio>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>

namespace {

constexpr const char* usage = R"(build/harness SCENE [name=value ...]

Runs a scene of a file (tests/benchmarks/scene_file.py) in the fused engine, without YADE, and prints a line of JSON for each measurement and one
for the end, whose hash is of all bits of the grains' motion: equal hashes are equal results.

  steps=500       small steps of one measurement
  threads=1       threads, or several by turns: threads=1,2
  domains=0       parts that the grains are divided into; 0: by their number
  instructions=   avx512, avx2, portable; empty: the best that this machine has
  together=50     small steps in one call of the engine, as subSteps of JKRWadaEngine
  warm=0          small steps before the first measurement
  out=            file for the scene at the end
)";

long wholeNumber(const std::string& name, const std::string& text, long least)
{
	std::istringstream digits(text);
	long number = 0;
	if (!(digits >> number && digits.eof()) || number < least || number > 1000000000)
		throw std::invalid_argument(name + " = " + text + ": must be a whole number of at least " + std::to_string(least));
	return number;
}

struct Settings {
	std::string scene;
	std::map<std::string, std::string> words { { "steps", "500" }, { "threads", "1" }, { "domains", "0" }, { "instructions", "" },
		{ "together", "50" }, { "warm", "0" }, { "out", "" } };

	const std::string& operator[](const char* name) const { return words.at(name); }

	long number(const char* name, long least = 1) const { return wholeNumber(name, words.at(name), least); }
	std::vector<long> threads() const
	{
		std::vector<long> found;
		std::istringstream parts(words.at("threads") + ',');
		for (std::string part; std::getline(parts, part, ',');)
			found.push_back(wholeNumber("threads", part, 1));
		return found;
	}
};

void take(Settings& settings, const std::string& argument)
{
	const std::size_t equals = argument.find('=');
	const auto known = settings.words.find(argument.substr(0, equals));
	if (equals == std::string::npos && settings.scene.empty())
		settings.scene = argument;
	else if (equals != std::string::npos && known != settings.words.end())
		known->second = argument.substr(equals + 1);
	else
		throw std::invalid_argument(argument + ": no such parameter; build/harness --help lists them");
}

void measure(harness::Run& run, const Settings& settings, long threads)
{
	contact_law::Dynamics& dynamics = run.dynamics();
	dynamics.setThreads(int(threads));
	const long steps = settings.number("steps"), together = settings.number("together");
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
	if (settings.scene.empty()) throw std::invalid_argument("no scene: must be given first; build/harness --help says more");
	const std::vector<long> threads = settings.threads();
	harness::Run run(harness::readScene(settings.scene), int(settings.number("domains", 0)), int(threads[0]), settings["instructions"]);
	const double energy = run.totalEnergy(), kinetic = run.kineticEnergy();
	run.run(settings.number("warm", 0), settings.number("together"));
	for (const long each : threads)
		measure(run, settings, each);
	const harness::Scene end = run.sceneNow();
	if (const std::string& out = settings["out"]; !out.empty()) harness::writeScene(out, end);
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
