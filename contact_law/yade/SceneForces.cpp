#include "JKRWadaEngineRun.hpp"
#include "../engine/contacts.hpp"
#include "Refusal.hpp"
#include "SceneGrains.hpp"
#include <algorithm>
#include <cmath>

namespace yade {

using contact_law::OutsideForce;

namespace {
	constexpr std::size_t numbersSaved = 7; // id, force, torque

	// YADE keeps no room for them until one is set; valid after sync().
	OutsideForce permanentOn(Scene& scene, int id)
	{
		if (!scene.forces.getPermForceUsed()) return { id, { 0, 0, 0 }, { 0, 0, 0 } };
		return { id, toKernel(scene.forces.getPermForce(id)), toKernel(scene.forces.getPermTorque(id)) };
	}

	bool hasForceResetter(const Scene& scene)
	{
		for (const auto& engine : scene.engines)
			if (!engine->dead && engine->getClassName() == "ForceResetter") return true;
		return false;
	}
}

std::vector<SceneForces::Load> SceneForces::notPermanent(Scene& scene)
{
	scene.forces.sync();
	std::vector<Load> all(scene.bodies->size());
	for (int id = 0; id < int(all.size()); ++id) {
		all[id] << scene.forces.getForce(id), scene.forces.getTorque(id);
		const OutsideForce kept = permanentOn(scene, id);
		all[id].head<3>() -= fromKernel(kept.force), all[id].tail<3>() -= fromKernel(kept.torque);
	}
	return all;
}

void SceneForces::write(
        Scene& scene, const SceneGrains& grains, const contact_law::Dynamics& dynamics, const std::vector<OutsideForce>& outside)
{
	withdraw(scene);
	std::vector<OutsideForce> added = contact_law::wholeForces(dynamics);
	// those of other engines are there until ForceResetter's turn; without it, only the permanent ones are
	const bool there = hasForceResetter(scene);
	before = notPermanent(scene);
	for (const OutsideForce& held : outside) {
		const OutsideForce shown = there ? held : permanentOn(scene, grains.idOf(held.grain));
		OutsideForce& of = added[held.grain];
		of.force = of.force - shown.force, of.torque = of.torque - shown.torque;
	}
	for (const OutsideForce& f : added) {
		scene.forces.addForce(grains.idOf(f.grain), fromKernel(f.force));
		scene.forces.addTorque(grains.idOf(f.grain), fromKernel(f.torque));
	}
	after = notPermanent(scene);
}

void SceneForces::withdraw(Scene& scene)
{
	if (after.empty()) return;
	std::vector<Load> left = notPermanent(scene);
	const std::size_t written = std::min(left.size(), after.size()); // there may be more bodies since, or none
	bool emptied = false; // by a script's O.forces.reset(): nothing that stands there is of write()
	for (std::size_t id = 0; id < written; ++id)
		emptied = emptied || (left[id].isZero(0) && after[id] != before[id]);
	for (std::size_t id = 0; id < written && !emptied; ++id)
		left[id] = before[id] + (left[id] - after[id]);
	scene.forces.reset(scene.iter);
	for (int id = 0; id < int(left.size()); ++id) {
		if (left[id].isZero(0)) continue;
		scene.forces.addForce(id, left[id].head<3>());
		scene.forces.addTorque(id, left[id].tail<3>());
	}
	before.clear(), after.clear();
}

void SceneForces::withdrawInStep(Scene& scene)
{
	if (hasForceResetter(scene))
		before.clear(), after.clear(); // they are gone
	else
		withdraw(scene);
}

std::vector<OutsideForce> SceneForces::take(Scene& scene, const SceneGrains& grains)
{
	std::vector<OutsideForce> found;
	scene.forces.sync();
	const int last = int(scene.bodies->size()) - 1;
	if (last > 0 && &scene.forces.getForce(0) == &scene.forces.getForce(last)) return found; // one zero for all: O.forces is empty
	for (int grain = 0; grain < int(grains.size()); ++grain) {
		const int id = grains.idOf(grain);
		const Vector3r &force = scene.forces.getForce(id), &torque = scene.forces.getTorque(id);
		if (force.isZero(0) && torque.isZero(0)) continue;
		if (!force.allFinite() || !torque.allFinite())
			refuseInEngine("O.forces has a force or torque on " + bodyName(id)
			        + " that is not a finite number: must be finite (O.forces.reset(False) clears it; a permanent one must be "
			          "set to 0 before)");
		found.push_back({ grain, toKernel(force), toKernel(torque) });
	}
	if (!hasForceResetter(scene)) scene.forces.reset(scene.iter);
	return found;
}

void SceneForces::takeBack(Scene& scene, const Engine& refused)
{
	const auto acts = [](const auto& engine) { return !engine->dead; };
	const auto first = std::find_if(scene.engines.begin(), scene.engines.end(), acts);
	if (first == scene.engines.end() || first->get() == &refused) return;
	scene.forces.sync(); // otherwise reset() leaves what was added since
	scene.forces.reset(scene.iter);
}

void SceneForces::dropThoseOfOtherEngines(Scene& scene, const SceneGrains& grains, bool ofContacts)
{
	if (scene.iter == 0 || hasForceResetter(scene)) return;
	if (!ofContacts) {
		for (const OutsideForce& f : take(scene, grains)) {
			const OutsideForce permanent = permanentOn(scene, grains.idOf(f.grain));
			if (f == OutsideForce { f.grain, permanent.force, permanent.torque }) continue;
			refuseInEngine("O.forces has a force or torque on " + bodyName(grains.idOf(f.grain))
			        + " from before this engine's first step: it must be 0 or permanent (O.forces.reset() clears it, "
			          "ForceResetter "
			          "as the first engine does so in every step)");
		}
	}
	scene.forces.reset(scene.iter);
}

std::vector<Real> SceneForces::permanent(Scene& scene)
{
	std::vector<Real> rows;
	if (!scene.forces.getPermForceUsed()) return rows;
	scene.forces.sync();
	for (int id = 0; id < int(scene.bodies->size()); ++id) {
		const auto [grain, force, torque] = permanentOn(scene, id);
		const Real row[numbersSaved] = { Real(grain), force.x, force.y, force.z, torque.x, torque.y, torque.z };
		if (std::any_of(row + 1, row + numbersSaved, [](Real x) { return x != 0; }))
			rows.insert(rows.end(), row, row + numbersSaved);
	}
	return contact_law::sealed(std::move(rows));
}

void SceneForces::restorePermanent(Scene& scene, const std::vector<Real>& rows)
{
	if (rows.empty()) return;
	contact_law::requireSealed(rows);
	if (scene.forces.getPermForceUsed()) {
		if (permanent(scene) == rows) return; // another engine of the checkpoint has restored them
		refuseInEngine("permanent forces were set before those of the checkpoint are in O.forces: call restoreForces() right after "
		               "O.load, or import contact_law before it");
	}
	for (std::size_t k = 0; k + numbersSaved <= rows.size(); k += numbersSaved) {
		const Real* row = &rows[k];
		scene.forces.setPermForce(int(row[0]), Vector3r(row[1], row[2], row[3]));
		scene.forces.setPermTorque(int(row[0]), Vector3r(row[4], row[5], row[6]));
	}
	scene.forces.sync(); // O.forces.permF() shows them
}

} // namespace yade
