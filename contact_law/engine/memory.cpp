// The whole state of a run as a row of numbers, for checkpoints that go on to the same bits.
#include "dynamics.hpp"
#include <stdexcept>

namespace contact_law {

namespace {
	class Reader {
	public:
		explicit Reader(const std::vector<double>& from_)
		        : from(from_)
		{
		}
		double next()
		{
			if (at == from.size())
				throw std::invalid_argument(
				        "the checkpoint of the grains is shorter than it should be: it was not written by this version");
			return from[at++];
		}
		int integer() { return int(next()); }
		Vec3<double> vector()
		{
			const double x = next(), y = next();
			return { x, y, next() };
		}
		bool done() const { return at == from.size(); }

	private:
		const std::vector<double>& from;
		std::size_t at = 0;
	};

	// A contact or a bond: its grains and its history.
	template <class Pair> void rememberPair(std::vector<double>& to, const Pair& pair)
	{
		const Vec3<double>&p = pair.history.pointers.n1, &q = pair.history.pointers.n2;
		to.insert(to.end(), { double(pair.i), double(pair.j), p.x, p.y, p.z, q.x, q.y, q.z, pair.history.twist });
	}
	template <class Pair> Pair recallPair(Reader& from)
	{
		Pair pair {};
		pair.i = from.integer(), pair.j = from.integer();
		pair.history.pointers.n1 = from.vector();
		pair.history.pointers.n2 = from.vector();
		pair.history.twist = from.next();
		return pair;
	}

	void remember(std::vector<double>& to, const Bond& b)
	{
		rememberPair(to, b);
		to.push_back(b.rest);
	}

	void recallBonds(Reader& from, Domain& domain, const Setting& setting)
	{
		for (BondList& list : domain.bonds) {
			list.clear();
			for (int lanes = from.integer(); lanes > 0; --lanes) {
				if (!from.next()) {
					list.appendDead();
					continue;
				}
				Bond b = recallPair<Bond>(from);
				b.rest = from.next();
				b.constants = setting.bondOf(b.i, b.j);
				list.append(b);
			}
		}
	}

	void remember(std::vector<double>& to, const Vec3<double>& v) { to.insert(to.end(), { v.x, v.y, v.z }); }
	void remember(std::vector<double>& to, const Contact& c)
	{
		rememberPair(to, c);
		to.insert(to.end(), { c.drag, c.overlap });
	}
}

std::vector<double> Dynamics::remember() const
{
	std::vector<double> to { double(count) };
	to.insert(to.end(), original.begin(), original.end());
	to.insert(to.end(),
	        { double(domains.size()), travelSinceFar, travelSinceNear, nearGap, double(contactUpdates), double(farRebuilds),
	                double(nearRebuilds) });
	to.push_back(cell().on);
	for (const Vec3<double>& v : { cell().size, cell().inverse, cell().rate, cell().rateBefore, mostCells, setting.convective })
		contact_law::remember(to, v);
	for (int k = 0; k < count; ++k) {
		const double* numbers = &setting.grains[k].x;
		to.insert(to.end(), numbers, numbers + sizeof(Grain) / sizeof(double));
		if (setting.hasDrag()) to.insert(to.end(), { setting.previous[k].x, setting.previous[k].y, setting.previous[k].z });
	}
	for (const auto& domain : domains) {
		const Dissipation& d = domain->sums.dissipated;
		for (const auto& channel : lostChannels)
			to.push_back(d.*channel.member);
		to.insert(to.end(), { domain->sums.eventWork, double(domain->events), double(domain->sortedBlocks) });
		const BoundaryWork& b = domain->sums.boundary;
		to.insert(to.end(), { b.done, domain->sums.meanField });
		contact_law::remember(to, b.kicks);
		contact_law::remember(to, b.early);
		to.insert(to.end(), { domain->constraints.work, double(domain->constraints.grains.size()) });
		for (const Constrained& c : domain->constraints.grains)
			to.insert(to.end(), { c.force.x, c.force.y, c.force.z, c.torque.x, c.torque.y, c.torque.z });
		to.insert(to.end(), domain->broken.begin(), domain->broken.end());
		for (const BondList& list : domain->bonds) {
			to.push_back(list.size());
			for (int lane = 0; lane < list.size(); ++lane) {
				to.push_back(list.alive(lane));
				if (list.alive(lane)) contact_law::remember(to, list.get(lane, setting.commonBond));
			}
		}
		for (const ContactList& list : domain->contacts) {
			to.push_back(list.size());
			for (int lane = 0; lane < list.size(); ++lane) {
				to.push_back(list.alive(lane));
				if (list.alive(lane)) contact_law::remember(to, setting.contactOf(list, lane));
			}
		}
	}
	return to;
}

void Dynamics::recallOrder(const std::vector<double>& memory)
{
	Reader from(memory);
	if (from.integer() != count) throw std::invalid_argument("the checkpoint holds another number of grains than the scene");
	original.resize(count);
	for (int& index : original)
		index = from.integer();
}

void Dynamics::recall(const std::vector<double>& memory)
{
	Reader from(memory);
	for (int skip = 0; skip <= count; ++skip)
		from.next(); // recallOrder has read these
	if (from.integer() != int(domains.size()))
		throw std::invalid_argument("the checkpoint holds another number of domains than the engine");
	travelSinceFar = from.next();
	travelSinceNear = from.next();
	nearGap = from.next();
	contactUpdates = long(from.next());
	farRebuilds = long(from.next());
	nearRebuilds = long(from.next());
	PeriodicCell cell;
	Vec3<double> most;
	cell.on = from.next();
	if (cell.on != options.cell.on) throw std::invalid_argument("O.periodic is another than in the checkpoint");
	for (Vec3<double>* v : { &cell.size, &cell.inverse, &cell.rate, &cell.rateBefore, &most, &setting.convective })
		*v = from.vector();
	for (int k = 0; k < count; ++k) {
		double* numbers = &setting.grains[k].x;
		for (std::size_t n = 0; n < sizeof(Grain) / sizeof(double); ++n)
			numbers[n] = from.next();
		if (setting.hasDrag()) {
			PreviousVelocity& v = setting.previous[k];
			v.x = from.next(), v.y = from.next(), v.z = from.next();
		}
	}
	for (auto& domain : domains) {
		Dissipation& d = domain->sums.dissipated;
		for (const auto& channel : lostChannels)
			d.*channel.member = from.next();
		domain->sums.eventWork = from.next();
		domain->events = long(from.next());
		domain->sortedBlocks = from.integer();
		domain->cell = cell;
		domain->sums.boundary.done = from.next();
		domain->sums.meanField = from.next();
		domain->sums.boundary.kicks = from.vector();
		domain->sums.boundary.early = from.vector();
		domain->constraints.work = from.next();
		if (from.integer() != int(domain->constraints.grains.size()))
			throw std::invalid_argument("blockedDOFs of a body are others than in the checkpoint");
		for (Constrained& c : domain->constraints.grains)
			for (double* number : { &c.force.x, &c.force.y, &c.force.z, &c.torque.x, &c.torque.y, &c.torque.z })
				*number = from.next();
		for (long& number : domain->broken)
			number = long(from.next());
		recallBonds(from, *domain, setting);
		for (ContactList& list : domain->contacts) {
			list.clear();
			for (int lanes = from.integer(); lanes > 0; --lanes) {
				if (!from.next()) {
					list.appendDead();
					continue;
				}
				Contact c = recallPair<Contact>(from);
				c.drag = from.next();
				c.overlap = from.next();
				c.constants = setting.constantsOf(c.i, c.j);
				list.append(c);
			}
		}
		domain->findCompleted();
	}
	if (!from.done())
		throw std::invalid_argument("the checkpoint of the grains is longer than it should be: it was not written by this version");
	const double sinceFar = travelSinceFar, sinceNear = travelSinceNear;
	refreshLists(true); // the pairs may be others than before, the contacts' order and the births to come are not
	travelSinceFar = sinceFar;
	travelSinceNear = sinceNear;
	mostCells = most;
}

} // namespace contact_law
