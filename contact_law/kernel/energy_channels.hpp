// The energy channels, listed once, by the names that O.energy, run folders and figures use. A new channel is a member of one of the structures
// below (of Dissipation, with an entry in lostMembers), a row of `channels`, and its label and colour in analysis/runs/format.py.
#pragma once
#include "numbers.hpp"
#include <array>
#include <cstddef>
#include <iterator>

namespace contact_law {

// What contacts hold now [J].
template <class T> struct StoredEnergy {
	T normal, sliding, rolling, twisting;
};
template <class T>
TABLE_ON_GPU constexpr T StoredEnergy<T>::*storedMembers[] = { &StoredEnergy<T>::normal, &StoredEnergy<T>::sliding,
	&StoredEnergy<T>::rolling, &StoredEnergy<T>::twisting };

// What contacts have dissipated [J]; a step's, or since the start.
template <class T> struct DissipationOf {
	T sliding = T(0.), rolling = T(0.), twisting = T(0.);
	T connection = T(0.), disconnection = T(0.); // contacts that formed, and broke
	T drag = T(0.), springDamping = T(0.);
	T bondStretching = T(0.), bondSliding = T(0.), bondRolling = T(0.), bondTwisting = T(0.); // sintered bonds that broke, by mode
};
template <class T>
TABLE_ON_GPU constexpr T DissipationOf<T>::*lostMembers[] = { &DissipationOf<T>::sliding, &DissipationOf<T>::rolling,
	&DissipationOf<T>::twisting, &DissipationOf<T>::connection, &DissipationOf<T>::disconnection, &DissipationOf<T>::drag,
	&DissipationOf<T>::springDamping, &DissipationOf<T>::bondStretching, &DissipationOf<T>::bondSliding, &DissipationOf<T>::bondRolling,
	&DissipationOf<T>::bondTwisting };
using Dissipation = DissipationOf<double>;
static_assert(sizeof(StoredEnergy<double>) == std::size(storedMembers<double>) * sizeof(double)
                && sizeof(Dissipation) == std::size(lostMembers<double>) * sizeof(double),
        "a member that is not listed would be left out of every sum");

// The modes by which a sintered bond breaks.
enum BondMode { ByStretching, BySliding, ByRolling, ByTwisting, bondModeCount };
TABLE_ON_GPU constexpr struct {
	const char* name; // of the number of broken bonds
	double Dissipation::*lost;
} bondModes[bondModeCount] = {
	{ "brokenByStretching", &Dissipation::bondStretching },
	{ "brokenBySliding", &Dissipation::bondSliding },
	{ "brokenByRolling", &Dissipation::bondRolling },
	{ "brokenByTwisting", &Dissipation::bondTwisting },
};

// All energies of a scene [J]. Their sum is constant in time.
struct Energies {
	double kinetic = 0; // 1/2 m v(-dt/2) v(+dt/2): what a leapfrog conserves together with the stored energies (MODEL.md)
	StoredEnergy<double> stored { 0, 0, 0, 0 };
	Dissipation dissipated;
	double boundaryWork = 0;   // done against a periodic cell's boundaries and mean velocity field
	double constraintWork = 0; // done by contacts on blocked degrees of freedom
	double externalWork = 0;   // done against outside forces: minus what these did on the grains
};

enum class ChannelKind {
	Stored, // held now
	Lost,   // dissipated since the start
	Work    // done since the start against what holds or moves the grains
};

struct Channel {
	const char* name;
	ChannelKind kind;
	double (*of)(const Energies&);
};
constexpr Channel channels[] = {
	{ "kinetic", ChannelKind::Stored, [](const Energies& e) { return e.kinetic; } },
	{ "normal", ChannelKind::Stored, [](const Energies& e) { return e.stored.normal; } },
	{ "sliding", ChannelKind::Stored, [](const Energies& e) { return e.stored.sliding; } },
	{ "rolling", ChannelKind::Stored, [](const Energies& e) { return e.stored.rolling; } },
	{ "twisting", ChannelKind::Stored, [](const Energies& e) { return e.stored.twisting; } },
	{ "slidingDissipation", ChannelKind::Lost, [](const Energies& e) { return e.dissipated.sliding; } },
	{ "rollingDissipation", ChannelKind::Lost, [](const Energies& e) { return e.dissipated.rolling; } },
	{ "twistingDissipation", ChannelKind::Lost, [](const Energies& e) { return e.dissipated.twisting; } },
	{ "connection", ChannelKind::Lost, [](const Energies& e) { return e.dissipated.connection; } },
	{ "disconnection", ChannelKind::Lost, [](const Energies& e) { return e.dissipated.disconnection; } },
	{ "drag", ChannelKind::Lost, [](const Energies& e) { return e.dissipated.drag; } },
	{ "springDamping", ChannelKind::Lost, [](const Energies& e) { return e.dissipated.springDamping; } },
	{ "bondBreaking", ChannelKind::Lost,
	        [](const Energies& e) {
	                const Dissipation& d = e.dissipated;
	                return d.bondStretching + d.bondSliding + d.bondRolling + d.bondTwisting;
	        } },
	{ "boundaryWork", ChannelKind::Work, [](const Energies& e) { return e.boundaryWork; } },
	{ "constraintWork", ChannelKind::Work, [](const Energies& e) { return e.constraintWork; } },
	{ "externalWork", ChannelKind::Work, [](const Energies& e) { return e.externalWork; } },
};
constexpr int channelCount = std::size(channels);

// The energies in the order of `channels` [J].
inline std::array<double, channelCount> byChannel(const Energies& e)
{
	std::array<double, channelCount> values {};
	for (int k = 0; k < channelCount; ++k)
		values[k] = channels[k].of(e);
	return values;
}

template <class T> ON_GPU inline StoredEnergy<T>& operator+=(StoredEnergy<T>& sum, const StoredEnergy<T>& e)
{
	for (const auto member : storedMembers<T>)
		sum.*member = sum.*member + e.*member;
	return sum;
}
template <class T> ON_GPU inline DissipationOf<T>& operator+=(DissipationOf<T>& sum, const DissipationOf<T>& d)
{
	for (const auto member : lostMembers<T>)
		sum.*member = sum.*member + d.*member;
	return sum;
}
ON_GPU inline double total(const StoredEnergy<double>& e)
{
	double sum = 0;
	for (const auto member : storedMembers<double>)
		sum += e.*member;
	return sum;
}
ON_GPU inline double total(const Dissipation& d)
{
	double sum = 0;
	for (const auto member : lostMembers<double>)
		sum += d.*member;
	return sum;
}

} // namespace contact_law
