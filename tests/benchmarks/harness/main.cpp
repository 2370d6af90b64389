/* The engine without YADE: runs a scene of a file and prints how fast, for profilers and machines with many processors. See usage below. */
#include "run.hpp"
#include <chrono>
#include <cstdio>
#include <map>

namespace {

constexpr const char* usage = R"(build/harness SCENE [name=value ...]

Runs a scene of a file (tests/benchmarks/scene_file.py) in the fused engine, without YADE, and prints one line of JSON. Its hash is of all bits of
the grains' motion: equal hashes are equal results.

  steps=500       small steps
  threads=1
  domains=0       parts that the grains are divided into; 0: by their number
  instructions=   avx512, avx2, portable; empty: the best that this machine has
  together=50     small steps in one call of the engine, as subSteps of JKRWadaEngine
  out=            file for the scene at the end
)";

struct Settings {
	std::map<std::string, std::string> texts { { "steps", "500" }, { "threads", "1" }, { "domains", "0" }, { "instructions", "" },
		{ "together", "50" }, { "out", "" } };

	void set(const std::string& argument)
	{
		const std::size_t equals = argument.find('=');
		if (equals == std::string::npos || !texts.count(argument.substr(0, equals)))
			throw std::invalid_argument(argument + ": no such parameter; build/harness --help lists them");
		texts[argument.substr(0, equals)] = argument.substr(equals + 1);
	}

	// The whole number of a parameter.
	int number(const std::string& name, int least = 1) const
	{
		std::size_t end = 0;
		int found = least - 1;
		try {
			found = std::stoi(texts.at(name), &end);
		} catch (const std::logic_error&) {
		}
		if (found < least || end < texts.at(name).size())
			throw std::invalid_argument(
			        name + "=" + texts.at(name) + ": must be a whole number of at least " + std::to_string(least));
		return found;
	}
};

void runScene(const std::string& path, const Settings& settings)
{
	const int steps = settings.number("steps"), together = settings.number("together");
	harness::Run run(
	        harness::readScene(path), settings.number("domains", 0), settings.number("threads"), settings.texts.at("instructions"));
	contact_law::Dynamics& dynamics = run.dynamics();
	const double energy = dynamics.totalEnergy();
	const double before = contact_law::contactCount(dynamics);
	const auto start = std::chrono::steady_clock::now();
	run.run(steps, together);
	const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	const double contacts = 0.5 * (before + contact_law::contactCount(dynamics)), energyChange = dynamics.totalEnergy() - energy;
	const harness::Scene end = run.sceneNow();
	if (const std::string& out = settings.texts.at("out"); !out.empty()) harness::writeScene(out, end);
	std::printf("{\"threads\": %d, \"domains\": %zu, \"instructions\": \"%s\", \"steps\": %d, \"msPerStep\": %.6g, \"contacts\": %.1f, "
	            "\"contactUpdatesPerSecond\": %.5g, \"grains\": %zu, \"time\": %.9g, \"energyChange\": %.6g, \"hash\": \"%016llx\"}\n",
	        dynamics.threadCount(), dynamics.parts().size(), dynamics.state().passes->name, steps, 1e3 * seconds / steps, contacts,
	        contacts * steps / seconds, end.grains.size(), end.head.time, energyChange, static_cast<unsigned long long>(run.hash()));
}

} // namespace

int main(int count, char** arguments)
{
	if (count < 2 || !std::strcmp(arguments[1], "--help")) return std::fputs(usage, count < 2 ? stderr : stdout) < 0 || count < 2;
	try {
		Settings settings;
		for (int k = 2; k < count; ++k)
			settings.set(arguments[k]);
		runScene(arguments[1], settings);
	} catch (const std::exception& error) {
		std::fprintf(stderr, "harness: %s\n", error.what());
		return 1;
	}
	return 0;
}
