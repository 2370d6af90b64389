// What all domains share: grains, materials, constants, options.
#pragma once
#include "../kernel/blocked.hpp"
#include "../kernel/contact_step.hpp"
#include "contact_lists.hpp"
#include "pair_lists.hpp"
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <string>

namespace contact_law {

// Which grains of a contact are a domain's own. A border contact stands in both domains: it is counted and booked where its first grain is
// owned.
enum Ownership { Interior, FirstOwned, SecondOwned };
constexpr Ownership ownerships[] = { Interior, FirstOwned, SecondOwned }, counted[] = { Interior, FirstOwned };
constexpr bool ownsFirst(Ownership o) { return o != SecondOwned; }
constexpr bool ownsSecond(Ownership o) { return o != FirstOwned; }
constexpr bool isCounted(Ownership o) { return ownsFirst(o); }

// The constants of a material, for those who go through them all.
struct MaterialRow {
	const char* name;
	double Material::*member;
};
constexpr MaterialRow materialList[] = {
#define CONTACT_LAW_MATERIAL_ROW(name, ...) { #name, &Material::name },
	CONTACT_LAW_MATERIAL(CONTACT_LAW_MATERIAL_ROW)
};

// In messages: the fewest digits that read back as the same number.
inline std::string textOf(double number)
{
	char buffer[32];
	for (int digits = 6; digits <= 17; ++digits) {
		std::snprintf(buffer, sizeof buffer, "%.*g", digits, number);
		if (std::strtod(buffer, nullptr) == number) break;
	}
	return buffer;
}

struct SharedState {
	Aligned<Grain> grains;                                   // then, for each domain, two dummies that unused slots point to
	std::vector<Group> groups;                               // of all domains
	std::vector<GroupCluster> clusters;                      // of them, by rising number
	std::vector<double> inverseMass, inverseInertia, radius; // radius: of the grain as contacts have it, shrunk where necks are
	std::vector<double> grainRadius;                         // before they shrank
	std::vector<Material> material;                          // kinds of material
	std::vector<int> kind;                                   // of each grain
	std::vector<Orientation> orientation;                    // likewise; none where the scene doesn't ask for them
	std::vector<PlaneInput> planes;                          // where they are now: each domain's plane_contacts.hpp
	std::vector<unsigned> blocked;                           // likewise (kernel/blocked.hpp)
	PairOptions pairs;
	double neck = 0; // radius of sintered bonds' necks over that of the grains, the largest, by which all grains have shrunk; 0: none
	std::vector<double> necks; // of the bonds in the scene, each once
	bool uniform = true;
	PairConstants<double> common {};     // of the first grain with itself; of every pair when all grains are equal
	BondConstants<double> commonBond {}; // likewise, when all bonds are of one neck
	unsigned mechanisms = AllSprings;
	LimitRule limit = LimitRule::Held;
	double dt = 0, skin = 0, smallestRadius = 0, largestRadius = 0; // skin: between the surfaces of pairs in the neighbour lists
	double leastKick = 0; // least bound on the change of a velocity in a step [m/s] (pair_lists.hpp), over r/dt:
	static constexpr double leastKickOver = 1e-8; // a pair a hundredth of a radius apart is then not checked for a thousand steps
	void setLeastKick() { leastKick = leastKickOver * smallestRadius / dt; }
	Vec3<double> convective { 0, 0, 0 }; // a periodic cell's grains are accelerated by this times their velocity [1/s]
	const InstructionSet* passes = nullptr;
	std::vector<Vec3<double>> displaced; // of each grain, by a script since the latest step [m]; empty when none was

	void displace(int grain, const Vec3<double>& by)
	{
		if (by.x == 0 && by.y == 0 && by.z == 0) return;
		displaced.resize(grains.size(), Vec3<double> { 0, 0, 0 });
		displaced[grain] = displaced[grain] + by;
	}
	// Of the first grain from the second, between nearest images.
	Vec3<double> separationOf(const PeriodicCell& cell, int i, int j) const
	{
		Vec3<double> separation = contact_law::separationOf(grains[i], grains[j]);
		nearestImage(cell, separation);
		return separation;
	}
	// Of a pair through the latest step, between nearest images; image: of the first grain.
	ContactMotion motionOf(const PeriodicCell&, int i, int j, Image& image) const;
	bool hasDrag() const { return mechanisms & Drag; }
	bool convects() const { return convective.x != 0 || convective.y != 0 || convective.z != 0; }
	Contact contactOf(const ContactList& list, int lane) const
	{
		return list.get(lane, constantsOf(list.first(lane), list.second(lane)));
	}
	PairConstants<double> constantsOf(int i, int j) const
	{
		return uniform ? common
		               : deriveShrunkPair(material[kind[i]], grainRadius[i], material[kind[j]], grainRadius[j], pairs, neck);
	}
	PairConstants<double> constantsOnPlane(int grain, int plane) const
	{
		constexpr double radius = std::numeric_limits<double>::infinity();
		return derivePair(material[kind[grain]], grainRadius[grain], material[planes[plane].kind], radius, pairs);
	}
	bool uniformBonds() const { return uniform && necks.size() <= 1; }
	BondConstants<double> bondOf(int i, int j, double beta) const
	{
		return uniformBonds() ? commonBond
		                      : deriveBond(material[kind[i]], grainRadius[i], material[kind[j]], grainRadius[j], pairs, beta);
	}
};

inline ContactMotion SharedState::motionOf(const PeriodicCell& cell, int i, int j, Image& image) const
{
	const Grain &a = grains[i], &b = grains[j];
	Vec3<double> separation = positionOf(a) - positionOf(b);
	image = nearestImage(cell, separation);
	const double along =
	        inverseMassAlong(separation, inverseMass[i], blocked[i]) + inverseMassAlong(separation, inverseMass[j], blocked[j]);
	return { separation, velocityOf(a) - velocityOf(b) + image.velocity, spinOf(a), spinOf(b), dt, along, image.velocity,
		inverseInertiaOf(inverseInertia[i], blocked[i]), inverseInertiaOf(inverseInertia[j], blocked[j]) };
}

} // namespace contact_law
