#include "SceneContacts.hpp"
#include "../kernel/turning.hpp"
#include "Refusal.hpp"
#include <core/Body.hpp>
#include <core/State.hpp>
#include <pkg/common/Sphere.hpp>
#include <algorithm>

namespace yade {

using contact_law::ContactNow;
using contact_law::Inherited;
using Vec3d = contact_law::Vec3<double>;

namespace {
	Vec3d toKernel(const Vector3r& v) { return { v[0], v[1], v[2] }; }
	Vector3r fromKernel(const Vec3d& v) { return Vector3r(v.x, v.y, v.z); }

	struct Ids {
		int low, high;
		explicit Ids(const Interaction& i)
		        : low(std::min(i.getId1(), i.getId2()))
		        , high(std::max(i.getId1(), i.getId2()))
		{
		}
		bool operator<(const Ids& other) const { return low != other.low ? low < other.low : high < other.high; }
	};

	Real radiusOf(const Scene& scene, int id) { return static_cast<const Sphere&>(*(*scene.bodies)[id]->shape).radius; }

	const State& stateOf(const Scene& scene, int id) { return *(*scene.bodies)[id]->state; }

	void writeContact(const Scene& scene, const ContactNow& c, SceneContacts::Stage stage, Interaction& interaction)
	{
		const State &state1 = stateOf(scene, c.first), &state2 = stateOf(scene, c.second);
		auto& geometry = static_cast<ScGeom&>(*interaction.geom);
		auto& phys = static_cast<JKRWadaPhys&>(*interaction.phys);
		interaction.cellDist = Vector3i(-int(c.shift.x), -int(c.shift.y), -int(c.shift.z)); // of body 2, not body 1
		geometry.normal = -fromKernel(c.geometry.normal);                                   // YADE's points from body 1 to body 2
		geometry.refR1 = radiusOf(scene, c.first); // YADE's geometry is that of the bodies, shrunk by sintering or not
		geometry.refR2 = radiusOf(scene, c.second);
		geometry.penetrationDepth = c.geometry.overlap
		        + (geometry.refR1 + geometry.refR2 - (c.bonded ? c.rest : c.constants.radius1 + c.constants.radius2));
		geometry.contactPoint = state1.pos + (geometry.refR1 - 0.5 * geometry.penetrationDepth) * geometry.normal;
		phys.set(c.geometry, c.forces, c.history.twist, fromKernel(c.velocity));
		phys.pointer1 = state1.ori.conjugate() * fromKernel(c.history.pointers.n1);
		phys.pointer2 = state2.ori.conjugate() * fromKernel(c.history.pointers.n2);
		phys.current = stage == SceneContacts::Stage::OfPositions;
		if (phys.bonded && !c.bonded) phys.endBond();
		phys.restDistance = c.rest;
	}

	/* The velocities through the step before the last: the last step's less what the contacts' forces added (but for impulses of contacts that formed or broke, which
	 * shows in the drag of that one grain and step only). */
	std::vector<Vec3d> velocitiesBefore(const Scene& scene, const std::vector<shared_ptr<Interaction>>& contacts, Real dt)
	{
		std::vector<Vec3d> forces(scene.bodies->size(), Vec3d { 0, 0, 0 });
		for (const auto& i : contacts) {
			const auto& phys = static_cast<const JKRWadaPhys&>(*i->phys);
			const Vec3d force = toKernel(phys.normalForce + phys.shearForce); // on body 2
			forces[i->getId1()] = forces[i->getId1()] - force;
			forces[i->getId2()] = forces[i->getId2()] + force;
		}
		for (size_t id = 0; id < forces.size(); ++id) {
			const State& s = stateOf(scene, int(id));
			const Vec3d push = contact_law::componentsOf(forces[id], ~s.blockedDOFs & 7);
			forces[id] = toKernel(s.vel) - (dt / s.mass) * push;
		}
		return forces;
	}
}

Inherited SceneContacts::take(Scene& scene, Real dt)
{
	Inherited inherited;
	held.clear();
	for (const auto& interaction : *scene.interactions) {
		if (!interaction->isReal()) continue;
		const auto* phys = dynamic_cast<const JKRWadaPhys*>(interaction->phys.get());
		if (phys && phys->touching && dynamic_cast<const ScGeom*>(interaction->geom.get())) held.push_back(interaction);
	}
	std::sort(held.begin(), held.end(), [](const auto& a, const auto& b) { return Ids(*a) < Ids(*b); });
	for (const auto& interaction : held) {
		const auto& phys = static_cast<const JKRWadaPhys&>(*interaction->phys);
		const int id1 = interaction->getId1(), id2 = interaction->getId2();
		const State &state1 = stateOf(scene, id1), &state2 = stateOf(scene, id2);
		Inherited::One one { id1, id2,
			{ { toKernel(state1.ori * phys.pointer1), toKernel(state2.ori * phys.pointer2) }, phys.twist }, phys.overlap,
			phys.dragForce, phys.bonded, phys.restDistance, phys.bonded ? phys.bond->neck : 0 };
		if (phys.bondToCome)
			refuseInEngine("the functors are about to sinter the contacts (sinter() was called since their last step): make a "
			               "step first");
		if (!phys.current) { // the bodies have turned since
			inherited.stepBehind = true;
			one.history.pointers.n1 = contact_law::turned(one.history.pointers.n1, -dt * toKernel(state1.angVel));
			one.history.pointers.n2 = contact_law::turned(one.history.pointers.n2, -dt * toKernel(state2.angVel));
		}
		inherited.contacts.push_back(one);
	}
	if (inherited.stepBehind) inherited.previous = velocitiesBefore(scene, held, dt);
	return inherited;
}

std::vector<SceneContacts::Place> SceneContacts::placesOf(const contact_law::Dynamics& dynamics, const IsThere& isThere)
{
	std::vector<Place> places;
	eachContact(dynamics, [&](const contact_law::ContactList& list, int slot, int first, int second) {
		places.push_back({ std::min(first, second), std::max(first, second), &list, nullptr, slot });
	});
	eachBond(dynamics, [&](const contact_law::BondList& list, int slot, int first, int second) {
		places.push_back({ std::min(first, second), std::max(first, second), nullptr, &list, slot });
	});
	const auto ofGone = [&](const Place& place) { return !(isThere(place.id1) && isThere(place.id2)); };
	if (isThere) places.erase(std::remove_if(places.begin(), places.end(), ofGone), places.end());
	std::sort(places.begin(), places.end(),
	        [](const Place& a, const Place& b) { return a.id1 != b.id1 ? a.id1 < b.id1 : a.id2 < b.id2; });
	return places;
}

ContactNow SceneContacts::Place::now(const contact_law::Dynamics& dynamics) const
{
	return bonds ? contactNow(dynamics, *bonds, slot) : contactNow(dynamics, *list, slot);
}

bool SceneContacts::inOrder(Scene& scene, const std::vector<Place>& places) const
{
	InteractionContainer& there = *scene.interactions;
	if (held.size() != places.size() || there.size() != places.size()) return false;
	for (size_t k = 0; k < places.size(); ++k) {
		const Ids ids(*held[k]);
		if (!held[k]->isReal() || there[k] != held[k] || ids.low != places[k].id1 || ids.high != places[k].id2) return false;
	}
	return true;
}

shared_ptr<Interaction> SceneContacts::made(const Scene& scene, const ContactNow& c, int id1, int id2)
{
	const shared_ptr<Interaction> interaction(new Interaction(id1, id2));
	const shared_ptr<JKRWadaPhys> phys(new JKRWadaPhys);
	phys->setConstants(constants.of(c.constants));
	if (c.bonded) phys->setBond(bonds.of(c.bond));
	interaction->geom = shared_ptr<ScGeom>(new ScGeom);
	interaction->phys = phys;
	interaction->iterBorn = scene.iter;
	interaction->iterMadeReal = scene.iter;
	return interaction;
}

void SceneContacts::arrange(Scene& scene, const std::vector<Place>& places)
{
	std::vector<shared_ptr<Interaction>> now;
	now.reserve(places.size());
	auto known = held.begin();
	for (const Place& place : places) {
		const auto before = [&](const Interaction& i) {
			const Ids ids(i);
			return ids.low != place.id1 ? ids.low < place.id1 : ids.high < place.id2;
		};
		while (known != held.end() && before(**known))
			++known;
		if (known != held.end() && (*known)->isReal() && Ids(**known).low == place.id1 && Ids(**known).high == place.id2)
			now.push_back(*known);
		else
			now.push_back(nullptr);
	}
	scene.interactions->clear();
	held.swap(now);
}

void SceneContacts::write(Scene& scene, const contact_law::Dynamics& dynamics, Stage stage, const IsThere& isThere)
{
	const std::vector<Place> places = placesOf(dynamics, isThere);
	const auto now = [&](size_t k, int id1) {
		const ContactNow c = places[k].now(dynamics);
		return c.first == id1 ? c : contact_law::swapped(c);
	};
	if (!inOrder(scene, places)) {
		arrange(scene, places);
		for (size_t k = 0; k < places.size(); ++k) {
			if (!held[k]) held[k] = made(scene, now(k, places[k].id1), places[k].id1, places[k].id2);
			scene.interactions->insert(held[k]);
		}
	}
#pragma omp parallel for num_threads(dynamics.threadCount())
	for (size_t k = 0; k < places.size(); ++k)
		writeContact(scene, now(k, held[k]->getId1()), stage, *held[k]);
}

void SceneContacts::requireKept(const Scene& scene) const
{
	InteractionContainer& there = *scene.interactions;
	const size_t real = std::count_if(held.begin(), held.end(), [](const auto& interaction) { return interaction->isReal(); });
	const size_t left = std::min(there.size(), real);
	if (left < held.size())
		refuseInEngine("O.interactions has " + std::to_string(left) + " contacts, must be the " + std::to_string(held.size())
		        + " that were written: this engine's contacts cannot be erased there");
}

bool SceneContacts::withdraw(Scene& scene)
{
	const bool any = !held.empty();
	if (any) scene.interactions->clear();
	held.clear();
	return any;
}

} // namespace yade
