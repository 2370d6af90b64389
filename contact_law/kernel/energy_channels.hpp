// The energy channels, listed once: name, where the energy stands, and whether it is stored, lost or work. Everything that adds up, books,
// saves or shows energies walks these lists. A new channel of dissipation is a member of DissipationOf and a row of lostChannelsOf (and its
// label and colour in analysis/runs/format.py).
#pragma once
#include <array>
#include <cstddef>
#include <iterator>

namespace contact_law {

enum class ChannelKind {
	Stored,
	Lost,
	Work
}; // held now; dissipated since the start; done since the start against what holds or moves the grains

template <class Owner, class T> struct ChannelRow {
	const char* name;
	T Owner::*member;
};

// What contacts hold now [J].
template <class T> struct StoredEnergy {
	T normal, sliding, rolling, twisting;

	StoredEnergy& operator+=(const StoredEnergy& e);
};
template <class T>
constexpr ChannelRow<StoredEnergy<T>, T> storedChannelsOf[] = {
	{ "normal", &StoredEnergy<T>::normal },
	{ "sliding", &StoredEnergy<T>::sliding },
	{ "rolling", &StoredEnergy<T>::rolling },
	{ "twisting", &StoredEnergy<T>::twisting },
};

// What contacts have dissipated [J]; a step's, or since the start.
template <class T> struct DissipationOf {
	T sliding = T(0.), rolling = T(0.), twisting = T(0.);
	T connection = T(0.), disconnection = T(0.); // contacts that formed, and broke
	T drag = T(0.);
	T bondStretching = T(0.), bondSliding = T(0.), bondRolling = T(0.), bondTwisting = T(0.); // sintered bonds that broke, by mode

	DissipationOf& operator+=(const DissipationOf& d);
};
// Rows of one name stand together and are one channel.
template <class T>
constexpr ChannelRow<DissipationOf<T>, T> lostChannelsOf[] = {
	{ "slidingDissipation", &DissipationOf<T>::sliding },
	{ "rollingDissipation", &DissipationOf<T>::rolling },
	{ "twistingDissipation", &DissipationOf<T>::twisting },
	{ "connection", &DissipationOf<T>::connection },
	{ "disconnection", &DissipationOf<T>::disconnection },
	{ "drag", &DissipationOf<T>::drag },
	{ "bondBreaking", &DissipationOf<T>::bondStretching },
	{ "bondBreaking", &DissipationOf<T>::bondSliding },
	{ "bondBreaking", &DissipationOf<T>::bondRolling },
	{ "bondBreaking", &DissipationOf<T>::bondTwisting },
};
using Dissipation = DissipationOf<double>;
inline constexpr auto& storedChannels = storedChannelsOf<double>;
inline constexpr auto& lostChannels = lostChannelsOf<double>;
static_assert(sizeof(StoredEnergy<double>) == std::size(storedChannels) * sizeof(double)
                && sizeof(Dissipation) == std::size(lostChannels) * sizeof(double),
        "a member that no row lists would be left out of everything");

// The mode by which a sintered bond breaks, and what that took.
enum BondMode { ByStretching, BySliding, ByRolling, ByTwisting, bondModes };
constexpr double Dissipation::*bondBreakingBy[bondModes] = { &Dissipation::bondStretching, &Dissipation::bondSliding,
	&Dissipation::bondRolling, &Dissipation::bondTwisting };

// All energies of a scene [J]. Their sum is constant in time.
struct Energies {
	double kinetic = 0; // 1/2 m v(-dt/2) v(+dt/2): what a leapfrog conserves together with the stored energies (MODEL.md)
	StoredEnergy<double> stored { 0, 0, 0, 0 };
	Dissipation dissipated;
	double boundaryWork = 0;   // done against a periodic cell's boundaries and mean velocity field
	double constraintWork = 0; // done by contacts on blocked degrees of freedom
	double externalWork = 0;   // done against outside forces: minus what these did on the grains
};
constexpr ChannelRow<Energies, double> grainChannels[] = { { "kinetic", &Energies::kinetic } };
constexpr ChannelRow<Energies, double> workChannels[] = {
	{ "boundaryWork", &Energies::boundaryWork },
	{ "constraintWork", &Energies::constraintWork },
	{ "externalWork", &Energies::externalWork },
};

template <class T> inline StoredEnergy<T>& StoredEnergy<T>::operator+=(const StoredEnergy& e)
{
	for (const auto& row : storedChannelsOf<T>)
		this->*row.member = this->*row.member + e.*row.member;
	return *this;
}
template <class T> inline DissipationOf<T>& DissipationOf<T>::operator+=(const DissipationOf& d)
{
	for (const auto& row : lostChannelsOf<T>)
		this->*row.member = this->*row.member + d.*row.member;
	return *this;
}
inline double total(const StoredEnergy<double>& e)
{
	double sum = 0;
	for (const auto& row : storedChannels)
		sum += e.*row.member;
	return sum;
}
inline double total(const Dissipation& d)
{
	double sum = 0;
	for (const auto& row : lostChannels)
		sum += d.*row.member;
	return sum;
}

// ---- the channels by number, in the order used everywhere ----

struct Channel {
	const char* name;
	ChannelKind kind;
};

namespace channel_numbers {
	constexpr bool same(const char* a, const char* b)
	{
		for (; *a && *a == *b; ++a, ++b) {
		}
		return *a == *b;
	}
	template <class Row, std::size_t rows>
	constexpr int distinct(const Row (&list)[rows], std::size_t upTo = rows) // names among the first rows
	{
		int count = 0;
		for (std::size_t k = 0; k < upTo; ++k)
			count += k == 0 || !same(list[k].name, list[k - 1].name);
		return count;
	}
	constexpr int storedFrom = distinct(grainChannels), lostFrom = storedFrom + distinct(storedChannels),
	              workFrom = lostFrom + distinct(lostChannels);
	constexpr std::array<int, std::size(lostChannels)> numberLost()
	{
		std::array<int, std::size(lostChannels)> numbers {};
		for (std::size_t row = 0; row < numbers.size(); ++row)
			numbers[row] = lostFrom + distinct(lostChannels, row + 1) - 1;
		return numbers;
	}
	constexpr auto ofLost = numberLost(); // of the channel that a row of lostChannels belongs to
}
constexpr int channelCount = channel_numbers::workFrom + channel_numbers::distinct(workChannels);

constexpr std::array<Channel, channelCount> makeChannels()
{
	std::array<Channel, channelCount> all {};
	int at = 0;
	for (const auto& row : grainChannels)
		all[at++] = { row.name, ChannelKind::Stored };
	for (const auto& row : storedChannels)
		all[at++] = { row.name, ChannelKind::Stored };
	for (std::size_t k = 0; k < std::size(lostChannels); ++k)
		all[channel_numbers::ofLost[k]] = { lostChannels[k].name, ChannelKind::Lost };
	at = channel_numbers::workFrom;
	for (const auto& row : workChannels)
		all[at++] = { row.name, ChannelKind::Work };
	return all;
}
constexpr auto channels = makeChannels();

// Of the channel with a name; -1: there is none.
constexpr int channelNumber(const char* name)
{
	for (int k = 0; k < channelCount; ++k)
		if (channel_numbers::same(channels[k].name, name)) return k;
	return -1;
}

constexpr bool numbersAgree()
{
	for (int k = 0; k < channelCount; ++k)
		if (channelNumber(channels[k].name) != k) return false;
	return true;
}
static_assert(numbersAgree(), "rows of one channel must stand together, and names of channels differ");

// visit(number of the channel, energy), of every row; rows of one channel one after the other.
template <class Visit> inline void eachRow(const StoredEnergy<double>& stored, const Dissipation& lost, Visit&& visit)
{
	for (std::size_t k = 0; k < std::size(storedChannels); ++k)
		visit(channel_numbers::storedFrom + int(k), stored.*storedChannels[k].member);
	for (std::size_t k = 0; k < std::size(lostChannels); ++k)
		visit(channel_numbers::ofLost[k], lost.*lostChannels[k].member);
}

// The energies by channel [J].
inline std::array<double, channelCount> byChannel(const Energies& e)
{
	std::array<double, channelCount> values {};
	for (std::size_t k = 0; k < std::size(grainChannels); ++k)
		values[k] = e.*grainChannels[k].member;
	eachRow(e.stored, e.dissipated, [&](int channel, double energy) { values[channel] += energy; });
	for (std::size_t k = 0; k < std::size(workChannels); ++k)
		values[channel_numbers::workFrom + k] = e.*workChannels[k].member;
	return values;
}

} // namespace contact_law
