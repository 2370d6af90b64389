// O.energy: sums by name.
#pragma once
#include <declare/overrides.hpp>
#include <lib/serialization/Serializable.hpp>
#include <map>

namespace yade {

class EnergyTracker : public Serializable {
	char energies[64] __attribute__((aligned(8)));
	EnergyTracker(); // made by YADE only

public:
	~EnergyTracker() override;
	YADE_INTERFACE_OVERRIDES_(EnergyTracker)

	// id is kept by the caller for the name, and starts at -1; reset: the sum starts anew each step. Exported by libpkg_dem. Not safe against
	// concurrent first calls of a name, and ids are stale after O.energy.clear().
	void add(const Real& value, const std::string& name, int& id, bool reset = false);
	std::map<std::string, int> names; // ids
	Real total() const;
	// What O.energy[name] = value calls, with no Python in it; makes the name if it is not there.
	void setItem_py(const std::string& name, Real value);

private:
	char more[40] __attribute__((aligned(8)));
};
static_assert(sizeof(EnergyTracker) == 176, "EnergyTracker");

} // namespace yade
