/* The whole state of a run as a row of numbers, for checkpoints that resume to the same bits. Neighbour lists are not in it: they are found anew.
 * Whoever changes what is transferred, or its order, raises formatNumber. */
#include "checkpoint_archive.hpp"
#include "dynamics.hpp"
#include "material_list.hpp"

namespace contact_law {

namespace {
	constexpr double magicNumber = 0x4A4B5257; // "JKRW"
	constexpr int formatNumber = 6; // 1: without this header, up to version 0.1; 2, 3: version 0.2; 4: version 0.3; 5, 6: version 0.4

	template <class Archive> void transfer(Archive& archive, Contact& c, const Setting& setting)
	{
		transferNumbers(archive, c.i, c.j);
		transfer(archive, c.history);
		transferNumbers(archive, c.drag, c.overlap);
		transfer(archive, c.velocity);
		if (Archive::restoring) c.constants = setting.constantsOf(c.i, c.j);
	}
	template <class Archive> void transfer(Archive& archive, Bond& b, const Setting& setting)
	{
		transferNumbers(archive, b.i, b.j);
		transfer(archive, b.history);
		double neck = b.constants.neck;
		transferNumbers(archive, b.rest, neck);
		if (Archive::restoring) b.constants = setting.bondOf(b.i, b.j, neck);
	}

	Contact get(const ContactList& list, int lane, const Setting& setting) { return setting.contactOf(list, lane); }
	Bond get(const BondList& list, int lane, const Setting& setting) { return list.get(lane, setting.commonBond); }

	// Lane by lane, dead ones too: sums over lanes are taken in the same order afterwards.
	template <class Pair, class Archive, class List> void transferLanes(Archive& archive, List& list, const Setting& setting)
	{
		int lanesUsed = list.size();
		archive.number(lanesUsed);
		if (Archive::restoring) list.clear();
		for (int lane = 0; lane < lanesUsed; ++lane) {
			bool alive = !Archive::restoring && list.alive(lane);
			archive.number(alive);
			if (!alive) {
				if (Archive::restoring) list.appendDead();
				continue;
			}
			Pair pair = Archive::restoring ? Pair {} : get(list, lane, setting);
			transfer(archive, pair, setting);
			if (Archive::restoring) list.append(pair);
		}
	}

	template <class Archive> void transfer(Archive& archive, Constraints& constraints)
	{
		std::size_t size = constraints.grains.size();
		archive.number(size);
		constraints.grains.resize(size);
		for (Constrained& c : constraints.grains) {
			transferNumbers(archive, c.grain, c.blocked);
			transfer(archive, c.force);
			transfer(archive, c.torque);
		}
		archive.number(constraints.work);
	}

	template <class Archive, class OfGrain> void transferPushes(Archive& archive, std::vector<OfGrain>& all)
	{
		std::size_t size = all.size();
		archive.number(size);
		all.resize(size);
		for (OfGrain& push : all) {
			archive.number(push.grain);
			transfer(archive, push.force);
			transfer(archive, push.torque);
		}
	}

	template <class Archive> void transfer(Archive& archive, Domain& domain, const Setting& setting)
	{
		transfer(archive, domain.cell);
		transfer(archive, domain.sums.dissipated);
		transferNumbers(archive, domain.sums.eventWork, domain.sums.meanField);
		transfer(archive, domain.sums.boundary);
		transferPushes(archive, domain.early);
		transfer(archive, domain.constraints);
		transferPushes(archive, domain.outside.grains);
		archive.number(domain.outside.work);
		transferNumbers(archive, domain.events, domain.formed, domain.broke, domain.sortedBlocks, domain.changed,
		        domain.stepsSinceSort, domain.lists.searches, domain.lists.looks);
		for (long& number : domain.broken)
			archive.number(number);
		for (BondList& list : domain.bonds)
			transferLanes<Bond>(archive, list, setting);
		for (ContactList& list : domain.contacts)
			transferLanes<Contact>(archive, list, setting);
	}
}

// What must be known before the grains can be laid out, and what must be as it was.
template <class Archive> void Dynamics::transferLayout(Archive& archive)
{
	const auto named = [](const char* name) { return [name] { return std::string(name); }; };
	archive.header(magicNumber, formatNumber);
	archive.same(count, named("the number of bodies"));
	archive.same(domainCount(), named("domains"));
	archive.same(int(options.cell.on), named("O.periodic"));
	archive.same(setting.material.size(), named("the number of materials"));
	archive.same(setting.pairs.linearDamping, named("linearDamping"));
	archive.same(setting.pairs.slidingStiffnessFactor, named("slidingStiffnessFactor"));
	archive.same(setting.neck, named("neck"));
	std::size_t necks = setting.necks.size();
	archive.number(necks);
	setting.necks.resize(necks);
	for (double& neck : setting.necks)
		archive.number(neck);
	archive.same(bool(setting.mechanisms & Sliding), named("sliding"));
	archive.same(bool(setting.mechanisms & Rolling), named("rolling"));
	archive.same(bool(setting.mechanisms & Twisting), named("twisting"));
	archive.same(int(setting.limit), named("limit (0: held, 1: cut)"));
	archive.same(setting.dt, named("the small step"));
	for (std::size_t kind = 0; kind < setting.material.size(); ++kind)
		for (const MaterialRow& row : materialList)
			archive.same(setting.material[kind].*row.member,
			        [&] { return std::string(row.name) + " of material " + std::to_string(kind); });
	original.resize(count);
	for (int k = 0; k < count; ++k) {
		archive.number(original[k]);
		if (original[k] < 0 || original[k] >= count)
			throw std::invalid_argument("the checkpoint of the grains is damaged: their order must be of 0 to N - 1");
		indexHere[original[k]] = k;
	}
}

template <class Archive> void Dynamics::transferState(Archive& archive)
{
	for (int k = 0; k < count; ++k) {
		const auto same = [&](double value, const char* name) {
			archive.same(value, [&] { return std::string(name) + " of body " + std::to_string(original[k]); });
		};
		same(setting.grainRadius[k], "the radius"), same(1 / setting.inverseMass[k], "the mass");
		same(1 / setting.inverseInertia[k], "the moment of inertia");
		same(setting.kind[k], "the number of the material");
		archive.number(setting.blocked[k]);
		transfer(archive, setting.grains[k]);
	}
	bool moved = !setting.displaced.empty();
	archive.number(moved);
	if (moved) setting.displaced.resize(setting.grains.size());
	for (Vec3<double>& by : setting.displaced)
		transfer(archive, by);
	transferNumbers(archive, contactUpdates, sizesWhenOrdered, stepsSinceTrial, orders);
	transfer(archive, setting.convective);
	for (auto& domain : domains)
		transfer(archive, *domain, setting);
}

std::vector<double> Dynamics::save()
{
	if (velocitiesSet) takeVelocities();
	SavingArchive to;
	transferLayout(to);
	transferState(to);
	return std::move(to.numbers);
}

Dynamics::Dynamics(const Grains& grains, const Materials& materials, const Options& options_, const std::vector<double>& saved)
        : options(options_)
{
	prepare(grains, materials);
	RestoringArchive from(saved);
	transferLayout(from);
	loadGrains(grains);
	makeDomains();
	transferState(from);
	if (!from.atEnd()) throw std::invalid_argument("the checkpoint of the grains is too long: it must be as O.save wrote it");
	for (auto& domain : domains)
		domain->findCompleted();
	std::vector<long> searches;
	for (auto& domain : domains)
		searches.push_back(domain->lists.searches);
	makeLists(); // the pairs may be others than before; the contacts' order and the contacts that will form are not
	for (std::size_t d = 0; d < domains.size(); ++d)
		domains[d]->lists.searches = searches[d];
}

} // namespace contact_law
