#include "JKRWada.hpp"
#include <core/Body.hpp>
#include <core/Cell.hpp>
#include <core/EnergyTracker.hpp>
#include <core/State.hpp>

namespace yade {

using contact_law::ContactHistory;
using contact_law::ContactMotion;
using contact_law::ContactStepResult;
using contact_law::PairConstants;
using Vec3d = contact_law::Vec3<double>;

YADE_PLUGIN((JKRMat)(JKRWadaConstants)(JKRWadaPhys)(Ip2_JKRMat_JKRMat_JKRWadaPhys)(Law2_ScGeom_JKRWadaPhys_JKRWada));

CREATE_LOGGER(Ip2_JKRMat_JKRMat_JKRWadaPhys);
CREATE_LOGGER(Law2_ScGeom_JKRWadaPhys_JKRWada);

namespace {
	Vec3d    toKernel(const Vector3r& v) { return { v[0], v[1], v[2] }; }
	Vector3r fromKernel(const Vec3d& v) { return Vector3r(v.x, v.y, v.z); }

	void require(bool fine, const char* name, Real value, const char* allowed)
	{
		if (!fine) throw std::invalid_argument("JKRMat: " + std::string(name) + " = " + boost::lexical_cast<std::string>(value) + ", allowed: " + allowed);
	}

	void requireRadius(Real radius) { require(radius > 0 && std::isfinite(radius), "radius of the grain", radius, "a positive number [m]"); }
}

void JKRMat::requireInRange() const
{
	require(young > 0 && std::isfinite(young), "young", young, "a positive number [Pa]");
	require(poisson >= 0 && poisson <= 0.5 && (poisson > 0 || viscoelasticTime == 0), "poisson", poisson, "0 to 0.5, and above 0 with drag");
	require(density > 0 && std::isfinite(density), "density", density, "a positive number [kg/m^3]");
	require(surfaceEnergy > 0 && std::isfinite(surfaceEnergy), "surfaceEnergy", surfaceEnergy, "a positive number [J/m^2]");
	require(criticalRolling > 0 && std::isfinite(criticalRolling), "criticalRolling", criticalRolling, "a positive number [m]");
	require(viscoelasticTime >= 0 && std::isfinite(viscoelasticTime), "viscoelasticTime", viscoelasticTime, "0 or a positive number [s]");
}

PairConstants<double> JKRWadaConstants::forKernel() const
{
	return { radius1,          radius2,          reducedRadius,     reducedMass,     reducedYoung,    reducedShear,     equilibriumContactRadius, equilibriumOverlap, pullOffOverlap, pullOffForce,
		 rollingStiffness, slidingStiffness, twistingStiffness, criticalSliding, criticalRolling, criticalTwisting, dragPerContactRadius,     linearDrag,         timeUnit, 1 / equilibriumOverlap };
}

void JKRWadaConstants::set(const PairConstants<double>& c)
{
	radius1                  = c.radius1;
	radius2                  = c.radius2;
	reducedRadius            = c.reducedRadius;
	reducedMass              = c.reducedMass;
	reducedYoung             = c.reducedYoung;
	reducedShear             = c.reducedShear;
	equilibriumContactRadius = c.equilibriumContactRadius;
	equilibriumOverlap       = c.equilibriumOverlap;
	pullOffOverlap           = c.pullOffOverlap;
	pullOffForce             = c.pullOffForce;
	rollingStiffness         = c.rollingStiffness;
	slidingStiffness         = c.slidingStiffness;
	twistingStiffness        = c.twistingStiffness;
	criticalSliding          = c.criticalSliding;
	criticalRolling          = c.criticalRolling;
	criticalTwisting         = c.criticalTwisting;
	dragPerContactRadius     = c.dragPerContactRadius;
	linearDrag               = c.linearDrag;
	timeUnit                 = c.timeUnit;
}

void Ip2_JKRMat_JKRMat_JKRWadaPhys::go(const shared_ptr<Material>& material1, const shared_ptr<Material>& material2, const shared_ptr<Interaction>& interaction)
{
	if (interaction->phys) return;
	const auto& first    = *YADE_CAST<JKRMat*>(material1.get());
	const auto& second   = *YADE_CAST<JKRMat*>(material2.get());
	const auto* geometry = YADE_CAST<GenericSpheresContact*>(interaction->geom.get());
	const auto  derived  = contact_law::derivePair(first.forKernel(), geometry->refR1, second.forKernel(), geometry->refR2, linearDamping);
	const auto  phys     = shared_ptr<JKRWadaPhys>(new JKRWadaPhys);
#pragma omp critical(JKRWadaConstantsLatest)
	{
		const auto same = [](const PairConstants<double>& a, const PairConstants<double>& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
		if (!latest || !same(latest->forKernel(), derived)) {
			latest = shared_ptr<JKRWadaConstants>(new JKRWadaConstants);
			latest->set(derived);
		}
		phys->constants = latest;
	}
	phys->kn          = 6 * derived.pullOffForce / (5 * derived.equilibriumOverlap); // A24 eq 38
	phys->ks          = derived.slidingStiffness;
	interaction->phys = phys;
}

boost::python::dict
Ip2_JKRMat_JKRMat_JKRWadaPhys::pairConstants(const shared_ptr<JKRMat>& material1, Real radius1, const shared_ptr<JKRMat>& material2, Real radius2) const
{
	material1->requireInRange();
	material2->requireInRange();
	requireRadius(radius1);
	requireRadius(radius2);
	JKRWadaConstants constants;
	constants.set(contact_law::derivePair(material1->forKernel(), radius1, material2->forKernel(), radius2, linearDamping));
	return constants.pyDict();
}

bool Law2_ScGeom_JKRWadaPhys_JKRWada::go(shared_ptr<IGeom>&, shared_ptr<IPhys>& physics, Interaction* interaction)
{
	JKRWadaPhys&                phys      = *YADE_CAST<JKRWadaPhys*>(physics.get());
	const PairConstants<double> constants = phys.constants->forKernel();
	const State&                state1    = *(*scene->bodies)[interaction->getId1()]->state;
	const State&                state2    = *(*scene->bodies)[interaction->getId2()]->state;

	Vector3r separation = state1.pos - state2.pos, velocity = state1.vel - state2.vel;
	if (scene->isPeriodic) {
		const Vector3r cells = interaction->cellDist.cast<Real>();
		separation -= scene->cell->hSize * cells;
		velocity -= scene->cell->velGrad * (scene->cell->prevHSize * cells);
	}
	const ContactMotion motion { toKernel(separation), toKernel(velocity), toKernel(state1.angVel), toKernel(state2.angVel), scene->dt, 1 / state1.mass + 1 / state2.mass };
	const contact_law::ContactBefore before { phys.touching, phys.overlap, phys.dragForce, toKernel(phys.slidingDisplacement), toKernel(phys.rollingDisplacement), phys.twist, toKernel(phys.velocity) };
	ContactHistory<double> history { { toKernel(state1.ori * phys.pointer1), toKernel(state2.ori * phys.pointer2) }, phys.twist };

	const bool     drag       = constants.dragPerContactRadius > 0 || constants.linearDrag > 0;
	const unsigned mechanisms = contact_law::mechanismsOf(sliding, rolling, twisting, drag);
	const ContactStepResult r  = contact_law::contactStepWith[mechanisms](constants, motion, before, history);

	const Vector3r force = fromKernel(r.force);
	scene->forces.addForce(interaction->getId1(), force);
	scene->forces.addForce(interaction->getId2(), -force);
	scene->forces.addTorque(interaction->getId1(), fromKernel(r.torque1));
	scene->forces.addTorque(interaction->getId2(), fromKernel(r.torque2));
	if (scene->trackEnergy) book(r);

	phys.touching = r.touching;
	if (!r.touching) return false;
	phys.overlap             = r.geometry.overlap;
	phys.slidingDisplacement = fromKernel(r.now.slidingDisplacement);
	phys.rollingDisplacement = fromKernel(r.now.rollingDisplacement);
	phys.twist              = history.twist;
	phys.dragForce          = r.now.drag;
	phys.velocity           = velocity;
	phys.normalForce        = -(r.now.normalForce + r.now.drag) * fromKernel(r.geometry.normal);
	phys.shearForce         = -fromKernel(r.now.sliding);
	if (r.pointersMoved) {
		phys.pointer1 = state1.ori.conjugate() * fromKernel(history.pointers.n1);
		phys.pointer2 = state2.ori.conjugate() * fromKernel(history.pointers.n2);
	}
	return true;
}

void Law2_ScGeom_JKRWadaPhys_JKRWada::book(const ContactStepResult& r)
{
	using C = EnergyChannels;
	channels.prepare(*scene);
	const auto add = [this](C::Channel channel, double energy) { channels.add(*scene, channel, energy); };
	add(C::Kinetic, r.workBefore);
	add(C::Normal, r.stored.normal);
	add(C::Sliding, r.stored.sliding);
	add(C::Rolling, r.stored.rolling);
	add(C::Twisting, r.stored.twisting);
	add(C::SlidingDissipation, r.dissipated.sliding);
	add(C::RollingDissipation, r.dissipated.rolling);
	add(C::TwistingDissipation, r.dissipated.twisting);
	add(C::Connection, r.dissipated.connection);
	add(C::Disconnection, r.dissipated.disconnection);
	add(C::Drag, r.dissipated.drag);
}

} // namespace yade
