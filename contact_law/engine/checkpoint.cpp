/* The whole state of a run as a row of numbers, for checkpoints that resume to the same bits. Neighbour lists are not in it: they are
 * made again. One list of what is transferred serves both directions (as in Boost.Serialization): the archive saves or restores. Numbers
 * are doubles, whole ones (below 2^53) and flags among them; the last is a sum of all others' bits. A change of what is transferred, or of
 * its order, raises formatNumber. */
#include "dynamics.hpp"
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace contact_law {

namespace {
	constexpr double magicNumber = 0x4A4B5257; // "JKRW"
	constexpr int formatNumber = 12;

	// Of the bits of all numbers before the last (FNV-1a, by words); whole, and below 2^53.
	double sumOfBits(const std::vector<double>& numbers, std::size_t count)
	{
		std::uint64_t sum = 14695981039346656037u;
		for (std::size_t k = 0; k < count; ++k) {
			std::uint64_t bits;
			std::memcpy(&bits, &numbers[k], sizeof bits);
			sum = (sum ^ bits) * 1099511628211u;
		}
		return double(sum >> 11);
	}

	struct SavingArchive {
		static constexpr bool restoring = false;
		std::vector<double> numbers;

		void header() { numbers.insert(numbers.end(), { magicNumber, double(formatNumber) }); }
		template <class T> void number(T& value) { numbers.push_back(double(value)); }
		// One that must be the same when the run is restored; its name and, if there is one, a number stand in the refusal.
		template <class T> void same(const T& value, const char*, const char* = "", int = 0) { numbers.push_back(double(value)); }
	};

	struct RestoringArchive {
		static constexpr bool restoring = true;
		const std::vector<double>& from;
		std::size_t at = 0;

		void header()
		{
			if (next() != magicNumber || next() != formatNumber)
				throw std::invalid_argument(
				        "the checkpoint of the grains is of another version: it must be of format " + textOf(formatNumber));
			requireSealed(from);
		}
		template <class T> void number(T& value) { value = T(next()); }
		template <class T> void same(const T& value, const char* name, const char* of = "", int number = 0)
		{
			const double saved = next();
			if (saved != double(value))
				throw std::invalid_argument(std::string(name) + of + (*of ? std::to_string(number) : "")
				        + " is another than in the checkpoint: it must be " + textOf(saved));
		}
		double next()
		{
			if (at == from.size())
				throw std::invalid_argument(
				        "the checkpoint of the grains is cut off: it must be whole, as O.save wrote it");
			return from[at++];
		}
	};

	template <class Archive, class... Numbers> void transferNumbers(Archive& archive, Numbers&... numbers)
	{
		(archive.number(numbers), ...);
	}

	// Structures of nothing but doubles, in the order of their members.
	template <class Archive, class... Structures> void transferDoubles(Archive& archive, Structures&... all)
	{
		const auto transferOne = [&](auto& one) {
			static_assert(std::is_trivially_copyable_v<std::decay_t<decltype(one)>> && sizeof one % sizeof(double) == 0);
			double* numbers = reinterpret_cast<double*>(&one);
			for (std::size_t k = 0; k < sizeof one / sizeof(double); ++k)
				archive.number(numbers[k]);
		};
		(transferOne(all), ...);
	}

	template <class Archive, class T> void transferSize(Archive& archive, std::vector<T>& all)
	{
		std::size_t size = all.size();
		archive.number(size);
		all.resize(size);
	}

	template <class Archive> void transfer(Archive& archive, Grain& g)
	{
		transferNumbers(archive, g.x, g.y, g.z, g.vx, g.vy, g.vz, g.wx, g.wy, g.wz, g.fx, g.fy, g.fz, g.tx, g.ty, g.tz);
	}
	template <class Archive> void transfer(Archive& archive, Contact& c, const SharedState& shared)
	{
		transferNumbers(archive, c.i, c.j);
		transferDoubles(archive, c.history, c.drag, c.overlap, c.velocity, c.damping);
		if (Archive::restoring) c.constants = shared.constantsOf(c.i, c.j);
	}
	template <class Archive> void transfer(Archive& archive, Bond& b, const SharedState& shared)
	{
		transferNumbers(archive, b.i, b.j);
		double neck = b.constants.neck;
		transferDoubles(archive, b.history, b.rest, neck);
		if (Archive::restoring) b.constants = shared.bondOf(b.i, b.j, neck);
	}

	Contact get(const ContactList& list, int slot, const SharedState& shared) { return shared.contactOf(list, slot); }
	Bond get(const BondList& list, int slot, const SharedState& shared) { return list.get(slot, shared.commonBond); }

	// Slot by slot, unused ones too: sums over them are taken in the same order afterwards.
	template <class Pair, class Archive, class List> void transferSlots(Archive& archive, List& list, const SharedState& shared)
	{
		int slots = list.size();
		archive.number(slots);
		if (Archive::restoring) list.clear();
		for (int slot = 0; slot < slots; ++slot) {
			bool used = !Archive::restoring && list.isUsed(slot);
			archive.number(used);
			if (!used) {
				if (Archive::restoring) list.appendUnused();
				continue;
			}
			Pair pair = Archive::restoring ? Pair {} : get(list, slot, shared);
			transfer(archive, pair, shared);
			if (Archive::restoring) list.append(pair);
		}
	}

	template <class Archive> void transfer(Archive& archive, Constraints& constraints)
	{
		transferSize(archive, constraints.grains);
		for (Constrained& c : constraints.grains) {
			transferNumbers(archive, c.grain, c.blocked);
			transferDoubles(archive, c.force, c.torque);
		}
		archive.number(constraints.work);
	}

	template <class Archive, class OfGrain> void transferPushes(Archive& archive, std::vector<OfGrain>& all)
	{
		transferSize(archive, all);
		for (OfGrain& push : all) {
			archive.number(push.grain);
			transferDoubles(archive, push.force, push.torque);
		}
	}

	template <class Archive> void transfer(Archive& archive, Domain& domain, const SharedState& shared)
	{
		transferDoubles(archive, domain.cell.size, domain.cell.inverse, domain.cell.rate);
		Ledger& ledger = domain.ledger;
		transferDoubles(archive, ledger.lost, ledger.eventWork, ledger.meanField, ledger.boundary);
		transferPushes(archive, ledger.early);
		transfer(archive, domain.constraints);
		transferPushes(archive, domain.outside.grains);
		archive.number(domain.outside.work);
		Counts& counts = ledger.counts;
		TouchingPairs::Order& order = domain.touching.order;
		transferNumbers(archive, counts.events, counts.formed, counts.broken, order.sortedBlocks, order.changed,
		        order.stepsSinceSort, domain.lists.searches, domain.lists.distanceChecks);
		for (long& number : counts.brokenBonds)
			archive.number(number);
		for (BondList& list : domain.touching.bonds)
			transferSlots<Bond>(archive, list, shared);
		for (ContactList& list : domain.touching.contacts)
			transferSlots<Contact>(archive, list, shared);
		domain.planes.transfer(archive);
	}
}

std::vector<double> sealed(std::vector<double> numbers)
{
	numbers.push_back(sumOfBits(numbers, numbers.size()));
	return numbers;
}

void requireSealed(const std::vector<double>& numbers)
{
	if (numbers.empty() || numbers.back() != sumOfBits(numbers, numbers.size() - 1))
		throw std::invalid_argument("the checkpoint of the grains is damaged: it must be as O.save wrote it");
}

template <class Archive> void PlaneContacts::transfer(Archive& archive)
{
	for (std::size_t p = 0; p < positions.size(); ++p)
		transferDoubles(archive, positions[p], after[p]);
	archive.number(work);
	transferSize(archive, contacts);
	for (PlaneContact& c : contacts) {
		transferNumbers(archive, c.grain, c.plane, c.side, c.before.touching, c.before.overlap, c.before.drag, c.before.twist);
		transferDoubles(archive, c.n1, c.point, c.before.sliding, c.before.rolling, c.before.velocity, c.before.damping);
		if (Archive::restoring) c.constants = s.constantsOnPlane(c.grain, c.plane);
	}
}

// What must be known before the grains can be laid out, and what must be as it was.
template <class Archive> void Dynamics::transferLayout(Archive& archive)
{
	archive.header();
	archive.same(count, "the number of bodies");
	archive.same(domainCount(), "domains");
	archive.same(int(options.cell.on), "O.periodic");
	archive.same(shared.material.size(), "the number of materials");
#define CONTACT_LAW_SAME(name, ...) archive.same(shared.pairs.name, #name);
	CONTACT_LAW_PAIR_OPTIONS(CONTACT_LAW_SAME)
	archive.same(shared.neck, "neck");
	transferSize(archive, shared.necks);
	for (double& neck : shared.necks)
		archive.number(neck);
	archive.same(bool(shared.mechanisms & Sliding), "sliding");
	archive.same(bool(shared.mechanisms & Rolling), "rolling");
	archive.same(bool(shared.mechanisms & Twisting), "twisting");
	archive.same(int(shared.limit), "limit (0: held, 1: cut)");
	archive.same(shared.dt, "the small step");
	for (std::size_t kind = 0; kind < shared.material.size(); ++kind)
		for (const MaterialRow& row : materialList)
			archive.same(shared.material[kind].*row.member, row.name, " of material ", int(kind));
	archive.same(shared.planes.size(), "the number of Walls");
	for (const PlaneInput& plane : shared.planes) {
		archive.same(plane.axis, "the axis", " of body ", plane.id);
		archive.same(plane.kind, "the number of the material", " of body ", plane.id);
	}
	original.resize(count);
	for (int k = 0; k < count; ++k) {
		archive.same(id(k), "the id", " of body ", id(k));
		archive.number(original[k]);
		indexHere[original[k]] = k;
	}
}

template <class Archive> void Dynamics::transferState(Archive& archive)
{
	for (int k = 0; k < count; ++k) {
		const int body = id(original[k]);
		archive.same(shared.grainRadius[k], "the radius", " of body ", body);
		archive.same(1 / shared.inverseMass[k], "the mass", " of body ", body);
		archive.same(1 / shared.inverseInertia[k], "the moment of inertia", " of body ", body);
		archive.same(shared.kind[k], "the number of the material", " of body ", body);
		archive.number(shared.blocked[k]);
		transfer(archive, shared.grains[k]);
	}
	bool moved = !shared.displaced.empty();
	archive.number(moved);
	if (moved) shared.displaced.resize(shared.grains.size());
	for (Vec3<double>& by : shared.displaced)
		transferDoubles(archive, by);
	transferNumbers(archive, contactUpdates, sizesWhenOrdered, stepsSinceTrial, orders);
	transferNumbers(archive, countedBefore.contactUpdates, countedBefore.searches, countedBefore.distanceChecks, countedBefore.orders);
	transferDoubles(archive, shared.convective);
	for (PlaneInput& plane : shared.planes)
		transferDoubles(archive, plane.velocity);
	for (auto& domain : domains)
		transfer(archive, *domain, shared);
}

std::vector<double> Dynamics::save()
{
	if (velocitiesSet) takeVelocities();
	SavingArchive to;
	transferLayout(to);
	transferState(to);
	return sealed(std::move(to.numbers));
}

Dynamics::Dynamics(const Grains& grains, const Materials& materials, const Options& options_, const std::vector<double>& saved)
{
	prepare(grains, materials, options_);
	RestoringArchive from { saved };
	transferLayout(from);
	loadGrains(grains);
	makeDomains();
	transferState(from);
	for (auto& domain : domains)
		domain->touching.findCompleted();
	std::vector<long> searches;
	for (auto& domain : domains)
		searches.push_back(domain->lists.searches);
	makeLists(); // the pairs may be others than before; the contacts' order and the contacts that will form are not
	for (std::size_t d = 0; d < domains.size(); ++d)
		domains[d]->lists.searches = searches[d];
}

} // namespace contact_law
