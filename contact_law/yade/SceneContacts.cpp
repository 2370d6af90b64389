#include "SceneContacts.hpp"
#include "Refusal.hpp"
#include "SceneShapes.hpp"
#include <algorithm>
#include <map>

namespace yade {

using contact_law::ContactNow;
using contact_law::Inherited;
using contact_law::PlaneContact;
using Vec3d = contact_law::Vec3<double>;

namespace {
	std::pair<int, int> idsOf(const Interaction& i) { return { std::min(i.getId1(), i.getId2()), std::max(i.getId1(), i.getId2()) }; }

	Real radiusOf(const Scene& scene, int id) { return static_cast<const Sphere&>(*(*scene.bodies)[id]->shape).radius; }

	const State& stateOf(const Scene& scene, int id) { return *(*scene.bodies)[id]->state; }

	Inherited::Pair inherited(
	        const JKRWadaPhys& phys, const Vec3d& normal, const State& state1, const State& state2, unsigned mechanisms)
	{
		Inherited::Pair one;
		one.history = { { toKernel(state1.ori * phys.pointer1), toKernel(state2.ori * phys.pointer2) }, phys.twist };
		one.drag = phys.dragForce, one.overlap = phys.overlap;
		if (phys.bonded)
			one.neck = phys.bond->neck, one.rest = phys.restDistance;
		else if (phys.bondToCome)
			one.neck = phys.bondToCome->neck;
		else if (const unsigned started = phys.started(mechanisms)) {
			contact_law::ContactBefore before = phys.before();
			contact_law::startSprings(mechanisms, started, phys.constants->forKernel(), normal, one.history, before);
		}
		return one;
	}

	PlaneContact inheritedOnPlane(
	        const JKRWadaPhys& phys, const Vec3d& normal, const State& wall, const State& grain, unsigned mechanisms)
	{
		PlaneContact c;
		c.side = normal.x + normal.y + normal.z; // along an axis
		c.n1 = toKernel(grain.ori * phys.pointer2);
		c.point = toKernel(phys.pointer1);
		c.before = phys.before();
		if (const unsigned started = phys.started(mechanisms)) {
			const Vec3d foot = contact_law::Plane { {}, normal, {} }.across(toKernel(grain.pos - wall.pos));
			contact_law::PlaneHistory<double> h { { { c.n1, normal }, c.point - foot }, c.before.twist };
			contact_law::startSprings(mechanisms, started, phys.constants->forKernel(), normal, h, c.before);
			c.n1 = h.pointers.n1;
			c.point = h.pointers.anchor + foot;
		}
		return c;
	}

	/* Bodies in the order of c's grains; the normal is YADE's, from body 1 to body 2. Of a contact with a Wall, this is the first body, and
	 * all is as Ig2_Wall_Sphere_ScGeom and the functors leave it. */
	void writeContact(const Scene& scene, const ContactNow& c, Interaction& interaction)
	{
		const int id1 = interaction.getId1(), id2 = interaction.getId2();
		const State &state1 = stateOf(scene, id1), &state2 = stateOf(scene, id2);
		auto& geometry = static_cast<ScGeom&>(*interaction.geom);
		auto& phys = static_cast<JKRWadaPhys&>(*interaction.phys);
		phys.set(c.geometry, c.forces, c.history.twist, fromKernel(c.velocity), c.damping, c.onPlane);
		geometry.refR2 = radiusOf(scene, id2); // of the bodies, shrunk by sintering or not
		if (c.onPlane) {
			const int axis = wallOf(scene, id1)->axis;
			geometry.normal = fromKernel(c.geometry.normal);
			geometry.refR1 = geometry.refR2;
			geometry.penetrationDepth = c.geometry.overlap;
			geometry.contactPoint = state2.pos;
			geometry.contactPoint[axis] = state1.pos[axis];
			phys.pointer1 = fromKernel(c.point);
			phys.pointer2 = state2.ori.conjugate() * fromKernel(c.history.pointers.n1);
			return;
		}
		interaction.cellDist = Vector3i(-int(c.shift.x), -int(c.shift.y), -int(c.shift.z)); // of body 2, not body 1
		geometry.normal = -fromKernel(c.geometry.normal);
		geometry.refR1 = radiusOf(scene, id1);
		geometry.penetrationDepth = c.geometry.overlap
		        + (geometry.refR1 + geometry.refR2 - (c.bonded ? c.rest : c.constants.radius1 + c.constants.radius2));
		geometry.contactPoint = state1.pos + (geometry.refR1 - 0.5 * geometry.penetrationDepth) * geometry.normal;
		phys.pointer1 = state1.ori.conjugate() * fromKernel(c.history.pointers.n1);
		phys.pointer2 = state2.ori.conjugate() * fromKernel(c.history.pointers.n2);
		phys.restDistance = c.rest;
	}

	bool isOfKind(const JKRWadaPhys& phys, const ContactNow& c)
	{
		return phys.bonded == c.bonded && SharedConstants::same(phys.constants->kind(), { c.constants, c.material1, c.material2 });
	}
}

Inherited SceneContacts::take(Scene& scene, const SceneGrains& grains, unsigned mechanisms)
{
	Inherited all;
	held.clear();
	for (const auto& interaction : *scene.interactions) {
		if (!interaction->isReal()) continue;
		const auto* phys = dynamic_cast<const JKRWadaPhys*>(interaction->phys.get());
		if (phys && phys->touching && dynamic_cast<const ScGeom*>(interaction->geom.get())) held.push_back(interaction);
	}
	std::sort(held.begin(), held.end(), [](const auto& a, const auto& b) { return idsOf(*a) < idsOf(*b); });
	for (const auto& interaction : held) {
		const auto& phys = static_cast<const JKRWadaPhys&>(*interaction->phys);
		const Vec3d normal = toKernel(static_cast<const ScGeom&>(*interaction->geom).normal);
		const int id1 = interaction->getId1(), id2 = interaction->getId2();
		const State &state1 = stateOf(scene, id1), &state2 = stateOf(scene, id2);
		const Inherited::Energy energy { phys.storedEnergy(), phys.energyWhenTorn() };
		if (wallOf(scene, id1)) {
			PlaneContact one = inheritedOnPlane(phys, normal, state1, state2, mechanisms);
			one.grain = grains.grainOf(id2), one.plane = grains.planeOf(id1);
			all.onPlanes.push_back({ one, energy });
		} else {
			Inherited::Pair one = inherited(phys, -normal, state1, state2, mechanisms);
			one.first = grains.grainOf(id1), one.second = grains.grainOf(id2);
			one.energy = energy;
			all.contacts.push_back(one);
		}
	}
	return all;
}

bool SceneContacts::ofFunctors() const
{
	return std::any_of(held.begin(), held.end(), [](const auto& one) { return !static_cast<const JKRWadaPhys&>(*one->phys).current; });
}

shared_ptr<Interaction> SceneContacts::made(const Scene& scene, int id1, int id2, const ContactNow& c)
{
	const shared_ptr<Interaction> interaction(new Interaction(id1, id2));
	const shared_ptr<JKRWadaPhys> phys(new JKRWadaPhys);
	phys->setConstants(constants.of({ c.constants, c.material1, c.material2 }));
	if (c.bonded) phys->setBond(bonds.of(c.bond));
	interaction->geom = shared_ptr<ScGeom>(new ScGeom);
	interaction->phys = phys;
	interaction->iterBorn = scene.iter;
	interaction->iterMadeReal = scene.iter;
	return interaction;
}

void SceneContacts::write(Scene& scene, const contact_law::Dynamics& dynamics, const IsThere& isThere)
{
	std::map<std::pair<int, int>, shared_ptr<Interaction>> known;
	for (const auto& interaction : held)
		if (interaction->isReal()) known[idsOf(*interaction)] = interaction;
	const std::vector<ContactNow> contacts = contactsNow(dynamics);
	std::vector<const ContactNow*> written;
	std::vector<shared_ptr<Interaction>> now;
	for (const ContactNow& c : contacts) {
		const int first = dynamics.id(c.first), second = c.onPlane ? dynamics.state().planes[c.second].id : dynamics.id(c.second);
		if (isThere && !(isThere(first) && isThere(second))) continue;
		const auto one = known.find({ std::min(first, second), std::max(first, second) });
		const bool stays = one != known.end() && isOfKind(static_cast<const JKRWadaPhys&>(*one->second->phys), c);
		now.push_back(stays ? one->second : made(scene, c.onPlane ? second : first, c.onPlane ? first : second, c));
		written.push_back(&c);
	}
	InteractionContainer& there = *scene.interactions;
	bool inOrder = now == held && there.size() == now.size();
	for (size_t k = 0; k < now.size() && inOrder; ++k)
		inOrder = there[k] == now[k];
	held.swap(now);
	if (!inOrder) {
		there.clear();
		for (const auto& interaction : held)
			there.insert(interaction);
	}
#pragma omp parallel for num_threads(dynamics.threadCount())
	for (size_t k = 0; k < held.size(); ++k) {
		auto& phys = static_cast<JKRWadaPhys&>(*held[k]->phys);
		phys.springs = int(dynamics.state().mechanisms);
		phys.current = true;
		writeContact(scene, *written[k], *held[k]);
	}
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
