#include "SceneContacts.hpp"
#include "../kernel/numbers.hpp"
#include "KernelVectors.hpp"
#include "Refusal.hpp"
#include "SceneShapes.hpp"
#include <core/Body.hpp>
#include <pkg/common/Sphere.hpp>
#include <algorithm>

namespace yade {

using contact_law::ContactNow;
using contact_law::Inherited;
using contact_law::InheritedContact;
using contact_law::PlaneContact;
using Vec3d = contact_law::Vec3<double>;

namespace {
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
		const int id1 = interaction.getId1(), id2 = interaction.getId2(); // of c.first, c.second
		const State &state1 = stateOf(scene, id1), &state2 = stateOf(scene, id2);
		auto& geometry = static_cast<ScGeom&>(*interaction.geom);
		auto& phys = static_cast<JKRWadaPhys&>(*interaction.phys);
		interaction.cellDist = Vector3i(-int(c.shift.x), -int(c.shift.y), -int(c.shift.z)); // of body 2, not body 1
		geometry.normal = -fromKernel(c.geometry.normal);                                   // YADE's points from body 1 to body 2
		geometry.refR1 = radiusOf(scene, id1); // YADE's geometry is that of the bodies, shrunk by sintering or not
		geometry.refR2 = radiusOf(scene, id2);
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

	ContactNow inOrderOf(const ContactNow& c, const contact_law::Dynamics& dynamics, int firstId)
	{
		return dynamics.id(c.first) == firstId ? c : contact_law::swapped(c);
	}

	// As Ig2_Wall_Sphere_ScGeom and the functors leave it: the Wall is the first body.
	void writeContact(const Scene& scene, const contact_law::PlaneContacts& all, const PlaneContact& c, SceneContacts::Stage stage,
	        Interaction& interaction)
	{
		const contact_law::ContactGeometry<double> g = all.geometryOf(c);
		const State &wall = stateOf(scene, interaction.getId1()), &grain = stateOf(scene, interaction.getId2());
		const int axis = wallOf(scene, interaction.getId1())->axis;
		auto& geometry = static_cast<ScGeom&>(*interaction.geom);
		auto& phys = static_cast<JKRWadaPhys&>(*interaction.phys);
		geometry.normal = fromKernel(g.normal);
		geometry.refR1 = geometry.refR2 = radiusOf(scene, interaction.getId2());
		geometry.penetrationDepth = g.overlap;
		geometry.contactPoint = grain.pos;
		geometry.contactPoint[axis] = wall.pos[axis];
		phys.set(g, all.forcesOf(c), c.before.twist, fromKernel(c.before.velocity), true);
		phys.pointer1 = fromKernel(c.point);
		phys.pointer2 = grain.ori.conjugate() * fromKernel(c.n1);
		phys.current = stage == SceneContacts::Stage::OfPositions;
	}

	Inherited::OnPlane onPlane(const JKRWadaPhys& phys, const Vec3d& normal, const State& grain)
	{
		Inherited::OnPlane one;
		one.contact.side = normal.x + normal.y + normal.z; // along an axis
		one.contact.n1 = toKernel(grain.ori * phys.pointer2);
		one.contact.point = toKernel(phys.pointer1);
		one.contact.before = phys.before();
		one.force = toKernel(phys.normalForce + phys.shearForce);
		return one;
	}

	// since: how long ago the contact's moment was.
	void startSprings(unsigned mechanisms, const JKRWadaPhys& phys, const State& wall, const Vec3d& normal, const State& grain,
	        Real since, PlaneContact& c)
	{
		const unsigned started = phys.started(mechanisms);
		if (!started) return;
		contact_law::PlaneHistory<double> h { { { c.n1, normal }, {} }, c.before.twist };
		const Vec3d foot =
		        contact_law::Plane { {}, normal, {} }.across(toKernel(grain.pos - wall.pos - since * (grain.vel - wall.vel)));
		h.pointers.anchor = c.point - foot;
		contact_law::startSprings(mechanisms, started, phys.constants->forKernel(), normal, h, c.before);
		c.n1 = h.pointers.n1;
		c.point = h.pointers.anchor + foot;
	}

	/* The velocities through the step before the last: the last step's less what the contacts' forces added (but for impulses of contacts that formed or broke, which
	 * shows in the drag of that one grain and step only). */
	std::vector<Vec3d> velocitiesBefore(
	        const Scene& scene, const SceneGrains& grains, const std::vector<shared_ptr<Interaction>>& contacts, Real dt)
	{
		std::vector<Vec3d> forces(scene.bodies->size(), Vec3d { 0, 0, 0 });
		for (const auto& i : contacts) {
			const auto& phys = static_cast<const JKRWadaPhys&>(*i->phys);
			const Vec3d force = toKernel(phys.normalForce + phys.shearForce); // on body 2
			forces[i->getId1()] = forces[i->getId1()] - force;
			forces[i->getId2()] = forces[i->getId2()] + force;
		}
		std::vector<Vec3d> velocities;
		for (size_t k = 0; k < grains.size(); ++k) {
			const State& s = grains.stateOf(k);
			const Vec3d push = contact_law::componentsOf(forces[grains.idOf(k)], ~s.blockedDOFs & 7);
			velocities.push_back(toKernel(s.vel) - (dt / s.mass) * push);
		}
		return velocities;
	}
}

Inherited SceneContacts::take(Scene& scene, const SceneGrains& grains, Real dt, unsigned mechanisms)
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
		const auto& geometry = static_cast<const ScGeom&>(*interaction->geom);
		if (phys.bondToCome)
			refuseInEngine("the functors are about to sinter the contacts (sinter() was called since their last step): make a "
			               "step first");
		inherited.stepBehind = inherited.stepBehind || !phys.current;
		const auto asOfHistory = [&](Vec3d& pointer, const State& state) { // the bodies have turned since
			if (!phys.current) pointer = contact_law::turned(pointer, -dt * toKernel(state.angVel));
		};
		if (wallOf(scene, id1)) {
			Inherited::OnPlane one = onPlane(phys, toKernel(geometry.normal), state2);
			one.grain = grains.grainOf(id2), one.plane = grains.planes.planeOf(id1);
			asOfHistory(one.contact.n1, state2);
			startSprings(mechanisms, phys, state1, toKernel(geometry.normal), state2, phys.current ? 0 : dt, one.contact);
			inherited.onPlanes.push_back(one);
			continue;
		}
		InheritedContact one { grains.grainOf(id1), grains.grainOf(id2),
			{ { toKernel(state1.ori * phys.pointer1), toKernel(state2.ori * phys.pointer2) }, phys.twist }, phys.before(),
			phys.bonded, phys.restDistance, phys.bonded ? phys.bond->neck : 0 };
		asOfHistory(one.history.pointers.n1, state1);
		asOfHistory(one.history.pointers.n2, state2);
		const unsigned started = phys.started(mechanisms);
		if (started && !phys.bonded)
			contact_law::startSprings(
			        mechanisms, started, phys.constants->forKernel(), -toKernel(geometry.normal), one.history, one.before);
		inherited.contacts.push_back(one);
	}
	inherited.step = std::max(dt, scene.dt);
	if (inherited.stepBehind) inherited.previous = velocitiesBefore(scene, grains, held, dt);
	return inherited;
}

std::vector<SceneContacts::Place> SceneContacts::placesOf(const contact_law::Dynamics& dynamics, const IsThere& isThere)
{
	std::vector<Place> places;
	const auto add = [&](int one, int other, Place place) {
		place.id1 = std::min(one, other), place.id2 = std::max(one, other);
		places.push_back(place);
	};
	eachContact(dynamics, [&](const contact_law::ContactList& list, int slot, int first, int second) {
		add(dynamics.id(first), dynamics.id(second), { 0, 0, &list, nullptr, slot });
	});
	eachBond(dynamics, [&](const contact_law::BondList& list, int slot, int first, int second) {
		add(dynamics.id(first), dynamics.id(second), { 0, 0, nullptr, &list, slot });
	});
	eachPlaneContact(dynamics, [&](const contact_law::Domain& domain, const contact_law::PlaneContact& contact) {
		add(dynamics.id(dynamics.given(contact.grain)), dynamics.state().planes[contact.plane].id,
		        { 0, 0, nullptr, nullptr, 0, &domain.planes, &contact });
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

shared_ptr<Interaction> SceneContacts::made(const Scene& scene, const contact_law::Dynamics& dynamics, const Place& place)
{
	const bool wallSecond = wallOf(scene, place.id2);
	const shared_ptr<Interaction> interaction(
	        wallSecond ? new Interaction(place.id2, place.id1) : new Interaction(place.id1, place.id2));
	const shared_ptr<JKRWadaPhys> phys(new JKRWadaPhys);
	if (place.onPlane)
		phys->setConstants(constants.of(place.onPlane->constants));
	else {
		const ContactNow c = inOrderOf(place.now(dynamics), dynamics, place.id1);
		phys->setConstants(constants.of(c.constants));
		if (c.bonded) phys->setBond(bonds.of(c.bond));
	}
	interaction->geom = shared_ptr<ScGeom>(new ScGeom);
	interaction->phys = phys;
	interaction->iterBorn = scene.iter;
	interaction->iterMadeReal = scene.iter;
	return interaction;
}

void SceneContacts::write(
        const Scene& scene, const contact_law::Dynamics& dynamics, const Place& place, Stage stage, Interaction& interaction)
{
	static_cast<JKRWadaPhys&>(*interaction.phys).springs = int(dynamics.state().mechanisms);
	if (place.onPlane)
		writeContact(scene, *place.planes, *place.onPlane, stage, interaction);
	else
		writeContact(scene, inOrderOf(place.now(dynamics), dynamics, interaction.getId1()), stage, interaction);
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
	if (!inOrder(scene, places)) {
		arrange(scene, places);
		for (size_t k = 0; k < places.size(); ++k) {
			if (!held[k]) held[k] = made(scene, dynamics, places[k]);
			scene.interactions->insert(held[k]);
		}
	}
#pragma omp parallel for num_threads(dynamics.threadCount())
	for (size_t k = 0; k < places.size(); ++k)
		write(scene, dynamics, places[k], stage, *held[k]);
}

std::string SceneContacts::erased(const Scene& scene) const
{
	InteractionContainer& there = *scene.interactions;
	const size_t real = std::count_if(held.begin(), held.end(), [](const auto& interaction) { return interaction->isReal(); });
	const size_t left = std::min(there.size(), real);
	if (left == held.size()) return "";
	return "O.interactions has " + std::to_string(left) + " contacts, must be the " + std::to_string(held.size())
	        + " that were written: this engine's contacts cannot be erased there";
}

bool SceneContacts::withdraw(Scene& scene)
{
	const bool any = !held.empty();
	if (any) scene.interactions->clear();
	held.clear();
	return any;
}

} // namespace yade
