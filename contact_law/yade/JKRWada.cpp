#include "JKRWada.hpp"
#include "../engine/dynamics.hpp"
#include "../kernel/bond.hpp"
#include "../kernel/blocked.hpp"
#include "Refusal.hpp"
#include <limits>
#include <sstream>

namespace yade {

using contact_law::ContactHistory;
using contact_law::ContactMotion;
using contact_law::ContactStepResult;
using contact_law::PairConstants;
using Vec3d = contact_law::Vec3<double>;

YADE_PLUGIN((JKRMat)(JKRWadaConstants)(JKRWadaBond)(JKRWadaPhys)(Ip2_JKRMat_JKRMat_JKRWadaPhys)(Law2_ScGeom_JKRWadaPhys_JKRWada));

namespace {
	// One line: what, its value, and what it must be. ValueError in Python.
	void require(bool fine, const std::string& what, Real value, const char* must)
	{
		if (fine) return;
		std::ostringstream text;
		text << what << " = " << value << ": must be " << must;
		throw std::invalid_argument(text.str());
	}
	void requirePositive(const std::string& what, Real value, const std::string& unit)
	{
		require(value > 0 && std::isfinite(value), what, value, ("> 0" + unit).c_str());
	}
	void requireNotNegative(const std::string& what, Real value, const std::string& unit)
	{
		require(value >= 0 && std::isfinite(value), what, value, (">= 0" + unit).c_str());
	}

	constexpr Real planeRadius = std::numeric_limits<Real>::infinity();
}

void JKRMat::requireInRange() const
{
	requirePositive("JKRMat: young", young, " [Pa]");
	require(poisson >= 0 && poisson <= 0.5 && (poisson > 0 || viscoelasticTime == 0), "JKRMat: poisson", poisson,
	        "from 0 to 0.5, and above 0 with drag");
	requirePositive("JKRMat: density", density, " [kg/m^3]");
	requirePositive("JKRMat: surfaceEnergy", surfaceEnergy,
	        " [J/m^2]: all limits of this law follow from adhesion; of grains without, YADE's Law2_ScGeom_MindlinPhys_Mindlin is the "
	        "law");
	requirePositive("JKRMat: criticalRolling", criticalRolling, " [m]");
	requireNotNegative("JKRMat: viscoelasticTime", viscoelasticTime, " [s]");
}

void JKRMat::postLoad(JKRMat&) { requireInRange(); }

void requireInRange(const contact_law::PairOptions& options, Real neck)
{
	requireNotNegative("linearDamping", options.linearDamping, "");
	requirePositive("slidingStiffnessFactor", options.slidingStiffnessFactor, "");
	requirePositive("rollingStiffnessFactor", options.rollingStiffnessFactor, "");
	requireNotNegative("springDamping", options.springDamping, " [s]");
	requirePositive("mixedSurfaceEnergyFactor", options.mixedSurfaceEnergyFactor, "");
	require(neck >= 0 && neck <= contact_law::largestNeck, "neck", neck, "0 (no bonds), or up to 0.7 for sintered bonds");
}

contact_law::LimitRule limitRuleOf(const std::string& name)
{
	for (std::size_t rule = 0; rule < std::size(contact_law::limitRuleNames); ++rule)
		if (name == contact_law::limitRuleNames[rule]) return contact_law::LimitRule(rule);
	throw std::invalid_argument("limit = '" + name + "': must be 'held' or 'cut'");
}

void Ip2_JKRMat_JKRMat_JKRWadaPhys::postLoad(Ip2_JKRMat_JKRMat_JKRWadaPhys&) { yade::requireInRange(options(), neck); }

// The attributes from and to the kernel's constants, one by one.
#define CONTACT_LAW_TO_KERNEL(name, ...) c.name = name;
#define CONTACT_LAW_FROM_KERNEL(name, ...) name = c.name;

void JKRMat::set(const contact_law::Material& c) { CONTACT_LAW_MATERIAL(CONTACT_LAW_FROM_KERNEL) }

PairConstants<double> JKRWadaConstants::forKernel() const
{
	PairConstants<double> c;
	CONTACT_LAW_PAIR_CONSTANTS(CONTACT_LAW_TO_KERNEL)
	c.complete();
	return c;
}

KindOfPair JKRWadaConstants::kind() const
{
	KindOfPair kind { forKernel(), {}, {} };
	std::memcpy(&kind.material1, materials.data(), sizeof kind.material1);
	std::memcpy(&kind.material2, materials.data() + materials.size() / 2, sizeof kind.material2);
	return kind;
}

void JKRWadaConstants::set(const KindOfPair& kind)
{
	const PairConstants<double>& c = kind.constants;
	CONTACT_LAW_PAIR_CONSTANTS(CONTACT_LAW_FROM_KERNEL)
	materials.clear();
	for (const contact_law::Material* material : { &kind.material1, &kind.material2 })
		for (const contact_law::MaterialRow& row : contact_law::materialList)
			materials.push_back(material->*row.member);
}

contact_law::BondConstants<double> JKRWadaBond::forKernel() const
{
	contact_law::BondConstants<double> c;
	CONTACT_LAW_BOND_CONSTANTS(CONTACT_LAW_TO_KERNEL)
	return c;
}

void JKRWadaBond::set(const contact_law::BondConstants<double>& c) { CONTACT_LAW_BOND_CONSTANTS(CONTACT_LAW_FROM_KERNEL) }

void JKRWadaPhys::setConstants(const shared_ptr<JKRWadaConstants>& c)
{
	constants = c;
	kn = 6 * c->pullOffForce / (5 * c->equilibriumOverlap); // A24 eq 38
	ks = c->slidingStiffness;
}

void JKRWadaPhys::setBond(const shared_ptr<JKRWadaBond>& b)
{
	bond = b;
	bonded = true;
	kn = b->normalStiffness;
	ks = b->slidingStiffness;
}

void JKRWadaPhys::endBond()
{
	bonded = false;
	bond.reset();
	setConstants(constants);
}

void JKRWadaPhys::takeConstantsToCome()
{
	setConstants(constantsToCome);
	if (bondToCome) setBond(bondToCome);
	bondToCome.reset();
	constantsToCome.reset();
}

void JKRWadaPhys::set(const contact_law::ContactGeometry<double>& g, const contact_law::ContactForces<double>& f, Real twist_,
        const Vector3r& velocity_, const contact_law::DampingMoment<double>& damping, bool ofPlane)
{
	const Real sign = ofPlane ? 1 : -1; // of the force on YADE's second body
	touching = true;
	overlap = g.overlap;
	slidingDisplacement = fromKernel(f.slidingDisplacement);
	rollingDisplacement = fromKernel(f.rollingDisplacement);
	twist = twist_;
	dragForce = f.drag;
	velocity = velocity_;
	slidingRate = fromKernel(damping.through.sliding), turningRate = fromKernel(damping.through.turning);
	slidingRateNow = fromKernel(damping.now.sliding), turningRateNow = fromKernel(damping.now.turning);
	normalForce = sign * (f.normalForce + f.drag) * fromKernel(g.normal);
	shearForce = sign * fromKernel(f.sliding);
}

contact_law::ContactBefore JKRWadaPhys::before() const
{
	return { touching, overlap, dragForce, toKernel(slidingDisplacement), toKernel(rollingDisplacement), twist, toKernel(velocity),
		{ { toKernel(slidingRate), toKernel(turningRate) }, { toKernel(slidingRateNow), toKernel(turningRateNow) } } };
}

Real JKRWadaPhys::storedEnergy() const
{
	const PairConstants<double> c = constants->forKernel();
	const contact_law::ContactGeometry<double> g { {}, 0, overlap };
	if (bonded || contact_law::normal::beyondPullOff(c, g)) return energyWhenTorn();
	contact_law::ContactForces<double> f = contact_law::ContactForces<double>::none();
	f.slidingDisplacement = toKernel(slidingDisplacement), f.rollingDisplacement = toKernel(rollingDisplacement);
	contact_law::normal::addForces(c, g, f);
	return total(contact_law::storedEnergy(unsigned(springs), c, f, twist));
}

Real JKRWadaPhys::energyWhenTorn() const
{
	return bonded ? contact_law::bonds::held(bond->forKernel(), before())
	              : contact_law::letGo(unsigned(springs), constants->forKernel(), before());
}

namespace {
	KindOfPair kindOf(const Scene& scene, const Interaction& interaction, const contact_law::PairOptions& options, Real neck)
	{
		const auto& geometry = *YADE_CAST<const GenericSpheresContact*>(interaction.geom.get());
		const auto materialOf = [&](Body::id_t id) { return YADE_CAST<JKRMat*>((*scene.bodies)[id]->material.get())->forKernel(); };
		const auto first = materialOf(interaction.getId1()), second = materialOf(interaction.getId2());
		if (wallOf(scene, interaction.getId1()))
			return { contact_law::derivePair(second, geometry.refR2, first, planeRadius, options), second, first };
		return { contact_law::deriveShrunkPair(first, geometry.refR1, second, geometry.refR2, options, neck), first, second };
	}

	contact_law::BondConstants<double> bondOf(
	        const KindOfPair& kind, const Interaction& interaction, const contact_law::PairOptions& options, Real neck)
	{
		const auto& geometry = *YADE_CAST<const GenericSpheresContact*>(interaction.geom.get());
		return contact_law::deriveBond(kind.material1, geometry.refR1, kind.material2, geometry.refR2, options, neck);
	}

	// visit(interaction, its JKRWadaPhys), of all that have one with constants
	template <class Visit> void eachContact(const Scene& scene, const Visit& visit)
	{
		for (const auto& interaction : *scene.interactions) {
			if (!interaction->isReal()) continue;
			auto* phys = dynamic_cast<JKRWadaPhys*>(interaction->phys.get());
			if (phys && phys->constants && dynamic_cast<const GenericSpheresContact*>(interaction->geom.get()))
				visit(*interaction, *phys);
		}
	}
}

void Ip2_JKRMat_JKRMat_JKRWadaPhys::go(
        const shared_ptr<Material>& material1, const shared_ptr<Material>& material2, const shared_ptr<Interaction>& interaction)
{
	const auto& first = *YADE_CAST<JKRMat*>(material1.get());
	const auto& second = *YADE_CAST<JKRMat*>(material2.get());
	if (interaction->phys) return requireSameMaterials(*YADE_CAST<JKRWadaPhys*>(interaction->phys.get()), first, second, *interaction);
	const auto* geometry = YADE_CAST<GenericSpheresContact*>(interaction->geom.get());
	const bool plane = wallOf(*scene, interaction->getId1());
	const auto phys = shared_ptr<JKRWadaPhys>(new JKRWadaPhys);
	interaction->phys = phys; // InteractionLoop wants one: where the contact is refused, without constants
	try {
		if (plane && neck != 0) throw std::invalid_argument(bondsOfPlanes);
		plane ? requireInRange(second, geometry->refR2, first, planeRadius)
		      : requireInRange(first, geometry->refR1, second, geometry->refR2);
	} catch (const std::invalid_argument& refusal) {
		return refuseInStep(*scene, std::string("Ip2_JKRMat_JKRMat_JKRWadaPhys: ") + refusal.what());
	}
	const KindOfPair kind = kindOf(*scene, *interaction, options(), neck);
	phys->setConstants(constants.of(kind));
	const auto* spheres = dynamic_cast<const ScGeom*>(geometry);
	const bool overlap = spheres && spheres->penetrationDepth > 0; // Ig2 may have found them further apart
	if (neck != 0 && overlap && scene->iter < bondsBefore) {
		const Real own = sinteredEarly > 0 ? sinteredEarly : neck;
		phys->setBond(bonds.of(bondOf(kind, *interaction, options(), own)));
	}
}

void Ip2_JKRMat_JKRMat_JKRWadaPhys::requireSameMaterials(
        const JKRWadaPhys& phys, const JKRMat& material1, const JKRMat& material2, const Interaction& interaction) const
{
	if (!phys.constants) return;
	const JKRWadaConstants& made = *(phys.constantsToCome ? phys.constantsToCome : phys.constants);
	const bool plane = std::isinf(made.radius2);
	const contact_law::Material materials[] = { (plane ? material2 : material1).forKernel(),
		(plane ? material1 : material2).forKernel() };
	if (std::memcmp(materials, made.materials.data(), sizeof materials) == 0) return;
	for (int k = 0; k < 2; ++k)
		for (std::size_t row = 0; row < std::size(contact_law::materialList); ++row)
			if (materials[k].*contact_law::materialList[row].member
			        != made.materials[k * std::size(contact_law::materialList) + row])
				return refuseInStep(*scene,
				        std::string("Ip2_JKRMat_JKRMat_JKRWadaPhys: the ") + contact_law::materialList[row].name
				                + " of the material of "
				                + bodyName((k == 0) != plane ? interaction.getId1() : interaction.getId2())
				                + changedMaterial);
}

void Ip2_JKRMat_JKRMat_JKRWadaPhys::setMaterial(const shared_ptr<JKRMat>& material, const shared_ptr<JKRMat>& as)
{
	requireLoopAtRest("set_material()");
	material->set(as->forKernel());
	const Scene& now = *Omega::instance().getScene();
	eachContact(now, [&](const Interaction& interaction, JKRWadaPhys& phys) {
		const KindOfPair kind = kindOf(now, interaction, options(), neck);
		if (!phys.constantsToCome && SharedConstants::same(phys.constants->kind(), kind)) return;
		const JKRWadaBond* bond = (phys.bondToCome ? phys.bondToCome : phys.bond).get();
		phys.constantsToCome = constants.of(kind);
		if (bond) phys.bondToCome = bonds.of(bondOf(kind, interaction, options(), bond->neck));
		if (!phys.touching) phys.takeConstantsToCome();
	});
}

void Ip2_JKRMat_JKRMat_JKRWadaPhys::sinter(Real neckNow)
{
	requireLoopAtRest("sinter()");
	require(neckNow > 0 && neckNow <= contact_law::largestNeck, "sinter(): neck", neckNow, "> 0 and up to 0.7");
	const Scene& now = *Omega::instance().getScene();
	for (const auto& interaction : *now.interactions)
		if (interaction->isReal() && wallOf(now, interaction->getId1())) throw std::invalid_argument(bondsOfPlanes);
	if (now.iter < bondsBefore && sinteredEarly == 0) sinteredEarly = neck > 0 ? neck : neckNow;
	neck = std::max(neck, neckNow);
	sinterContacts(now, options(), neckNow, neck, constants, bonds);
}

void sinterContacts(const Scene& scene, const contact_law::PairOptions& options, Real neck, Real largestNeck, SharedConstants& constants,
        SharedBonds& bonds)
{
	eachContact(scene, [&](const Interaction& interaction, JKRWadaPhys& phys) {
		const KindOfPair kind = kindOf(scene, interaction, options, largestNeck);
		const auto shrunk = constants.of(kind);
		const bool torn = phys.current && phys.overlap < -phys.constants->pullOffOverlap;
		if (phys.bonded || !phys.touching || torn)
			(phys.constantsToCome ? phys.constantsToCome : phys.constants) = shrunk; // of the contact that may come
		else {
			phys.constantsToCome = shrunk;
			// one that was sintered since the latest step keeps its neck
			if (!phys.bondToCome) phys.bondToCome = bonds.of(bondOf(kind, interaction, options, neck));
		}
	});
}

void Ip2_JKRMat_JKRMat_JKRWadaPhys::requireInRange(const JKRMat& material1, Real radius1, const JKRMat& material2, Real radius2) const
{
	yade::requireInRange(options(), neck);
	material1.requireInRange();
	material2.requireInRange();
	requirePositive("radius1", radius1, " [m]");
	require(radius2 > 0, "radius2", radius2, "> 0 [m]; inf for a plane");
	require(neck == 0 || std::isfinite(radius2), "neck", neck, "0 against a plane: there are no sintered bonds to planes");
}

boost::python::dict Ip2_JKRMat_JKRMat_JKRWadaPhys::pairConstants(
        const shared_ptr<JKRMat>& material1, Real radius1, const shared_ptr<JKRMat>& material2, Real radius2) const
{
	requireInRange(*material1, radius1, *material2, radius2);
	JKRWadaConstants constants;
	const contact_law::Material first = material1->forKernel(), second = material2->forKernel();
	constants.set({ contact_law::deriveShrunkPair(first, radius1, second, radius2, options(), neck), first, second });
	return constants.pyDict();
}

boost::python::dict Ip2_JKRMat_JKRMat_JKRWadaPhys::bondConstants(
        const shared_ptr<JKRMat>& material1, Real radius1, const shared_ptr<JKRMat>& material2, Real radius2) const
{
	requireInRange(*material1, radius1, *material2, radius2);
	require(neck > 0, "neck", neck, "> 0: without one there are no bonds");
	JKRWadaBond bond;
	bond.set(contact_law::deriveBond(material1->forKernel(), radius1, material2->forKernel(), radius2, options(), neck));
	return bond.pyDict();
}

void Law2_ScGeom_JKRWadaPhys_JKRWada::postLoad(Law2_ScGeom_JKRWadaPhys_JKRWada&) { limitRule = limitRuleOf(limit); }

unsigned Law2_ScGeom_JKRWadaPhys_JKRWada::mechanismsOf(const PairConstants<double>& c) const
{
	return contact_law::mechanismsOf(sliding, rolling, twisting, c.dragPerContactRadius > 0 || c.linearDrag > 0, c.springDamping > 0);
}

bool Law2_ScGeom_JKRWadaPhys_JKRWada::stepIsBelow(Real unstable) const
{
	const bool is = scene->dt > 0 && scene->dt < unstable;
	if (!is) refuseInStep(*scene, "Law2_ScGeom_JKRWadaPhys_JKRWada: " + tooLong("step O.dt", scene->dt, unstable));
	return is;
}

bool Law2_ScGeom_JKRWadaPhys_JKRWada::isWithin(const Interaction& interaction, Real overlap, Real radius) const
{
	const bool is = overlap <= radius;
	if (!is)
		refuseInStep(*scene,
		        "Law2_ScGeom_JKRWadaPhys_JKRWada: " + tooDeep(interaction.getId1(), interaction.getId2(), overlap / radius)
		                + ": must be at most 1");
	return is;
}

bool Law2_ScGeom_JKRWadaPhys_JKRWada::go(shared_ptr<IGeom>& geometry, shared_ptr<IPhys>& physics, Interaction* interaction)
{
	if (!shapes.fit(*scene)) return true;
	JKRWadaPhys& phys = *YADE_CAST<JKRWadaPhys*>(physics.get());
	if (!phys.constants) return false; // refused by Ip2, which is called again in the next step
	const PairConstants<double> constants = phys.constants->forKernel();
	const State& state1 = *(*scene->bodies)[interaction->getId1()]->state;
	const State& state2 = *(*scene->bodies)[interaction->getId2()]->state;
	const bool ofPlane = std::isinf(constants.radius2);
	const auto reduced = [&](Real first, Real second) { return ofPlane ? second : first * second / (first + second); };
	const auto turning = [](const State& state, Real radius) { return contact_law::massByInertia(state.inertia[0], radius); };
	const Real mass = reduced(state1.mass, state2.mass);
	const Real ofTurning =
	        reduced(turning(state1, constants.radius1), turning(state2, ofPlane ? constants.radius1 : constants.radius2));
	const Real light = contact_law::lightness(std::min(mass, ofTurning), constants.reducedMass);
	if (!stepIsBelow(contact_law::unstableStep(constants, light))) return true;
	if (constants.springDamping > 0 && !(sliding && rolling && twisting)) {
		refuseInStep(*scene, std::string("Law2_ScGeom_JKRWadaPhys_JKRWada: ") + dampedWithoutSprings);
		return true;
	}
	if (ofPlane) return goPlane(*YADE_CAST<ScGeom*>(geometry.get()), phys, constants, *interaction);

	Vector3r separation = state1.pos - state2.pos, velocity = state1.vel - state2.vel, imageVelocity = Vector3r::Zero();
	if (scene->isPeriodic) {
		const Vector3r cells = interaction->cellDist.cast<Real>();
		separation -= scene->cell->hSize * cells;
		imageVelocity = -(scene->cell->velGrad * (scene->cell->prevHSize * cells));
		velocity += imageVelocity;
	}
	const Real smaller = std::min(constants.radius1, constants.radius2);
	if (!isWithin(*interaction, constants.radius1 + constants.radius2 - separation.norm(), smaller)) return true;
	const Vec3d apart = toKernel(separation);
	const double inverseMass = contact_law::inverseMassAlong(apart, 1 / state1.mass, state1.blockedDOFs)
	        + contact_law::inverseMassAlong(apart, 1 / state2.mass, state2.blockedDOFs);
	const Real dt = phys.current ? 0 : scene->dt; // JKRWadaEngine has brought the contact here already
	const ContactMotion motion { apart, toKernel(velocity), toKernel(state1.angVel), toKernel(state2.angVel), dt, inverseMass,
		toKernel(imageVelocity), contact_law::inverseInertiaOf(1 / state1.inertia[0], state1.blockedDOFs),
		contact_law::inverseInertiaOf(1 / state2.inertia[0], state2.blockedDOFs) };
	if (phys.bonded
	        && !stepIsBelow(contact_law::unstableStep(
	                phys.bond->forKernel(), motion.inverseMass, motion.inverseInertia1, motion.inverseInertia2)))
		return true;
	contact_law::ContactBefore before = phys.before();
	ContactHistory<double> history { { toKernel(state1.ori * phys.pointer1), toKernel(state2.ori * phys.pointer2) }, phys.twist };

	const unsigned mechanisms = mechanismsOf(constants), started = phys.started(mechanisms);
	if (started && !phys.bonded)
		contact_law::startSprings(mechanisms, started, constants, (1 / std::sqrt(dot(apart, apart))) * apart, history, before);
	const auto step = [&](const PairConstants<double>& c, const ContactMotion& m, const contact_law::ContactBefore& then,
	                          contact_law::LimitRule limit) {
		return phys.bonded ? bondStep(phys, c, m, then, history, mechanismsOf(c))
		                   : contact_law::contactStepWith[mechanismsOf(c)](c, limit, m, then, history);
	};
	ContactStepResult r = step(constants, motion, before, limitRule);

	if (phys.constantsToCome && r.touching)
		phys.bondToCome && !phys.bonded ? sinter(phys, motion, history, r)
		                                : changeConstants(phys, motion, before, history.twist, r, step);
	if (!finish(*interaction, phys, motion, history.twist, mechanisms, r)) return false;
	if (r.pointersMoved || started) {
		phys.pointer1 = state1.ori.conjugate() * fromKernel(history.pointers.n1);
		phys.pointer2 = state2.ori.conjugate() * fromKernel(history.pointers.n2);
	}
	return true;
}

// A grain (the interaction's second body) and a plane, at one step.
bool Law2_ScGeom_JKRWadaPhys_JKRWada::goPlane(
        const GenericSpheresContact& geometry, JKRWadaPhys& phys, const PairConstants<double>& constants, const Interaction& interaction)
{
	const State& wall = *(*scene->bodies)[interaction.getId1()]->state;
	const State& grain = *(*scene->bodies)[interaction.getId2()]->state;
	const Real dt = phys.current ? 0 : scene->dt; // JKRWadaEngine has brought the contact here already
	const contact_law::Plane plane { toKernel(wall.pos), toKernel(geometry.normal), toKernel(wall.vel) };
	const ContactMotion motion = contact_law::motionPast(plane, toKernel(grain.pos), toKernel(grain.vel), toKernel(grain.angVel), dt,
	        contact_law::inverseMassAlong(plane.normal, 1 / grain.mass, grain.blockedDOFs),
	        contact_law::inverseInertiaOf(1 / grain.inertia[0], grain.blockedDOFs));
	// YADE turns the normal where a grain's centre passes the plane: it was on the other side a step ago
	const Real overlap = constants.radius1 - dot(motion.separation, plane.normal);
	if (!isWithin(interaction, overlap + std::max(Real(0), dt * dot(motion.velocity, plane.normal)), constants.radius1)) return true;
	const Vec3d foot = plane.across(toKernel(grain.pos - wall.pos)); // of the grain's centre, from the wall's position
	contact_law::PlaneHistory<double> history {
		{ { toKernel(grain.ori * phys.pointer2), plane.normal }, toKernel(phys.pointer1) - foot }, phys.twist
	};
	contact_law::ContactBefore before = phys.before();
	const unsigned mechanisms = mechanismsOf(constants), started = phys.started(mechanisms);
	if (started) contact_law::startSprings(mechanisms, started, constants, plane.normal, history, before);
	const auto step = [&](const PairConstants<double>& c, const ContactMotion& m, const contact_law::ContactBefore& then,
	                          contact_law::LimitRule limit) {
		return contact_law::planeStepWith[mechanismsOf(c)](c, limit, m, then, history);
	};
	ContactStepResult r = step(constants, motion, before, limitRule);
	if (phys.constantsToCome && r.touching) changeConstants(phys, motion, before, history.twist, r, step);

	if (!finish(interaction, phys, motion, history.twist, mechanisms, r)) return false;
	if (r.pointersMoved || started) {
		phys.pointer1 = fromKernel(history.pointers.anchor + foot);
		phys.pointer2 = grain.ori.conjugate() * fromKernel(history.pointers.n1);
	}
	return true;
}

// What a step did, but for the pointers. Returns whether the contact is there still.
bool Law2_ScGeom_JKRWadaPhys_JKRWada::finish(const Interaction& interaction, JKRWadaPhys& phys, const ContactMotion& motion, Real twist,
        unsigned mechanisms, const ContactStepResult& r)
{
	const bool ofPlane = std::isinf(phys.constants->radius2);
	const int id1 = interaction.getId1(), id2 = interaction.getId2(), grain1 = ofPlane ? id2 : id1, other = ofPlane ? id1 : id2;
	const Vector3r force = fromKernel(r.force);
	scene->forces.addForce(grain1, force);
	scene->forces.addForce(other, -force);
	scene->forces.addTorque(grain1, fromKernel(r.torque1));
	if (!ofPlane) scene->forces.addTorque(other, fromKernel(r.torque2));
	if (scene->trackEnergy) {
		channels.prepare(*scene);
		contact_law::Energies energies;
		energies.kinetic = r.workBefore;
		energies.stored = r.stored;
		energies.dissipated = r.dissipated;
		// half of the kick a step ago, and what belongs before this instant; the forces of phys are still those on body 2 a step
		// ago
		const Vector3r before =
		        phys.touching ? (ofPlane ? 0.5 : -0.5) * (phys.normalForce + phys.shearForce) : Vector3r(Vector3r::Zero());
		const Real work = motion.dt * (before + fromKernel(r.forceBefore)).dot(fromKernel(motion.imageVelocity));
		if (ofPlane)
			energies.constraintWork = work;
		else if (scene->isPeriodic)
			energies.boundaryWork = work;
		channels.add(*scene, energies);
	}
	phys.touching = r.touching;
	if (!r.touching) return false;
	phys.set(r.geometry, r.now, twist, fromKernel(motion.velocity), r.damping, ofPlane);
	phys.current = false;
	phys.springs = int(mechanisms);
	return true;
}

/* The contact ends at this instant: it gives the half kick before it, and the bond, which takes its place without strain, the one after it.
 * (The second-order part of the kinetic energy that goes with a grain's forces, which the fused engine books, is left out.) */
void Law2_ScGeom_JKRWadaPhys_JKRWada::sinter(
        JKRWadaPhys& phys, const ContactMotion& motion, ContactHistory<double>& history, ContactStepResult& r)
{
	r.force = r.forceBefore;
	r.torque1 = r.torqueBefore1;
	r.torque2 = r.torqueBefore2;
	r.dissipated.disconnection += total(r.stored);
	r.stored = { 0, 0, 0, 0 };
	phys.takeConstantsToCome();
	phys.restDistance = contact_law::newBond(motion.separation, history);
	r.geometry = contact_law::geometryOf(motion.separation, phys.restDistance);
	r.now = contact_law::ContactForces<double>::none();
	r.pointersMoved = true;
}

/* Constants of another material: the contact gives the half kick before this instant with the old ones, the one after it with the new. What
 * it holds changes where it is, which constraintWork takes. step: of no length, held at the new limits. */
template <class Step>
void Law2_ScGeom_JKRWadaPhys_JKRWada::changeConstants(JKRWadaPhys& phys, ContactMotion motion, const contact_law::ContactBefore& before,
        Real twist, ContactStepResult& r, const Step& step)
{
	const contact_law::ContactBefore now { true, r.geometry.overlap, r.now.drag, r.now.slidingDisplacement, r.now.rollingDisplacement,
		twist, before.velocity, { before.damping.through, r.damping.now } };
	motion.dt = 0;
	phys.takeConstantsToCome();
	const PairConstants<double> constants = phys.constants->forKernel();
	if (!stepIsBelow(contact_law::unstableStep(constants))) return;
	const ContactStepResult changed = step(constants, motion, now, contact_law::LimitRule::Held);
	r.force = r.forceBefore + 0.5 * changed.force;
	r.torque1 = r.torqueBefore1 + 0.5 * changed.torque1;
	r.torque2 = r.torqueBefore2 + 0.5 * changed.torque2;
	if (scene->trackEnergy) {
		contact_law::Energies energies;
		energies.constraintWork = total(r.stored) - total(changed.stored) - total(changed.dissipated);
		channels.prepare(*scene);
		channels.add(*scene, energies);
	}
	r.touching = changed.touching, r.geometry = changed.geometry, r.now = changed.now;
	r.stored = changed.stored, r.dissipated += changed.dissipated, r.damping.now = changed.damping.now;
	r.pointersMoved = r.pointersMoved || changed.pointersMoved;
}

ContactStepResult Law2_ScGeom_JKRWadaPhys_JKRWada::bondStep(JKRWadaPhys& phys, const PairConstants<double>& constants, ContactMotion motion,
        const contact_law::ContactBefore& before, ContactHistory<double>& history, unsigned mechanisms)
{
	const bool made = !phys.touching; // this is its first step
	if (made) {
		phys.restDistance = contact_law::newBond(motion.separation, history);
		motion.dt = 0;
	}
	contact_law::BondStepResult r =
	        contact_law::bondStepWith[mechanisms](phys.bond->forKernel(), constants, motion, before, phys.restDistance, history);
	r.contact.pointersMoved = r.contact.pointersMoved || made;
	if (r.bonded) return r.contact;
	phys.endBond();
	int* const counters[] = { &brokenByStretching, &brokenBySliding, &brokenByRolling, &brokenByTwisting };
#pragma omp atomic
	++*counters[r.mode];
	return r.contact;
}

} // namespace yade

// What the compiler's flags make of floating-point arithmetic (tests/equivalence/test_floating_point.py).
extern "C" {

// a b + c as the functors compute it, or (set = "avx512", "avx2", "portable") as the engine's passes do; not a number where the machine
// lacks the set.
double contact_law_sum_of_product(const char* set, double a, double b, double c)
{
	if (!*set) return a * b + c;
	try {
		return contact_law::instructionSet(set).sumOfProduct(a, b, c);
	} catch (const std::exception&) {
		return std::numeric_limits<double>::quiet_NaN();
	}
}

// (a + b) - a, which -ffast-math would make b
double contact_law_reassociated(double a, double b) { return (a + b) - a; }
}
