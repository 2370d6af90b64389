// Cohesive elastic grains: the JKR normal force with the sliding, rolling and twisting springs of Wada et al. (2007), and viscous drag.
// The formulas stand in ../kernel; MODEL.md lists them with their sources. These classes carry them into YADE.
#pragma once
#include "../kernel/bond.hpp"
#include "../kernel/contact_step.hpp"
#include "EnergyChannels.hpp"
#include "SceneShapes.hpp"
#include <cstring>

namespace yade {

inline contact_law::Vec3<double> toKernel(const Vector3r& v) { return { v[0], v[1], v[2] }; }
inline Vector3r fromKernel(const contact_law::Vec3<double>& v) { return Vector3r(v.x, v.y, v.z); }

// What the kernel's lists have, as YADE attributes.
#define CONTACT_LAW_PAIR_ATTRIBUTE(name, readByForces, documentation) ((Real, name, 0, Attr::readonly, documentation))
#define CONTACT_LAW_BOND_ATTRIBUTE(name, documentation) ((Real, name, 0, Attr::readonly, documentation))
#define CONTACT_LAW_OPTION_ATTRIBUTE(name, usual, documentation) ((Real, name, usual, , documentation))
#define CONTACT_LAW_CHECKED_OPTION(name, usual, documentation) ((Real, name, usual, Attr::triggerPostLoad, documentation))
#define CONTACT_LAW_VALUE(name, ...) name,

class JKRMat : public ElastMat {
public:
	contact_law::Material forKernel() const { return { CONTACT_LAW_MATERIAL(CONTACT_LAW_VALUE) }; }
	void set(const contact_law::Material&);
	void requireInRange() const; // throws std::invalid_argument
	void postLoad(JKRMat&);      // likewise: when the material is made or loaded, and when an attribute below is set
	virtual ~JKRMat() {}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(JKRMat, ElastMat,
		"Adhesive elastic grains that obey the JKR contact law with Wada's tangential springs (Wada et al. 2007; Arakawa et al. "
		"2022, Table 1). "
		"The defaults are those of water ice; young (7e9 Pa), poisson (0.25) and density (1000 kg/m^3) are attributes of YADE's "
		"own.",
		((Real, surfaceEnergy, 0.1, Attr::triggerPostLoad, "Surface energy gamma [J/m^2]. A pair takes the geometric mean, times mixedSurfaceEnergyFactor."))
		((Real, criticalRolling, 8e-10, Attr::triggerPostLoad, "Rolling displacement xi_crit beyond which grains roll "
			"irreversibly [m]. A pair takes the arithmetic mean."))
		((Real, viscoelasticTime, 0, Attr::triggerPostLoad, "Viscoelastic time T_vis of the normal drag 2 T_vis E*/nu^2 a v [s]; "
			"0: no drag. A pair takes the arithmetic mean of T_vis/nu^2.")),
		createIndex(); young = 7e9;
	);
	// clang-format on
	REGISTER_CLASS_INDEX(JKRMat, ElastMat);
};
REGISTER_SERIALIZABLE(JKRMat);

// Constants, and the materials that they are of; with a plane, the grain's is the first.
struct KindOfPair {
	contact_law::PairConstants<double> constants;
	contact_law::Material material1, material2;
};

class JKRWadaConstants : public Serializable {
public:
	contact_law::PairConstants<double> forKernel() const;
	KindOfPair kind() const;
	void set(const KindOfPair&);
	virtual ~JKRWadaConstants() {}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(JKRWadaConstants, Serializable,
		"What two materials and two radii make of a contact: derived once, shared by all contacts of the same kind. Symbols and "
		"sources: contact_law/MODEL.md.",
		CONTACT_LAW_PAIR_CONSTANTS(CONTACT_LAW_PAIR_ATTRIBUTE)
		((std::vector<Real>, materials, , Attr::readonly|Attr::hidden, "The constants of both materials."))
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(JKRWadaConstants);

class JKRWadaBond : public Serializable {
public:
	contact_law::BondConstants<double> forKernel() const;
	contact_law::BondConstants<double> kind() const { return forKernel(); }
	void set(const contact_law::BondConstants<double>&);
	virtual ~JKRWadaBond() {}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(JKRWadaBond, Serializable,
		"Constants of sintered bonds (Sirono & Ueno 2017), shared by all bonds of the same kind. Symbols and sources: "
		"contact_law/MODEL.md.",
		CONTACT_LAW_BOND_CONSTANTS(CONTACT_LAW_BOND_ATTRIBUTE)
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(JKRWadaBond);

// Objects for contacts (bonds) of the same kind: most scenes have one kind of pair.
template <class Object, class Derived> class SharedObject {
	shared_ptr<Object> latest;

public:
	static bool same(const Derived& a, const Derived& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
	shared_ptr<Object> of(const Derived& derived) // from any thread
	{
		shared_ptr<Object> result;
#pragma omp critical(SharedObjectLatest)
		{
			if (!latest || !same(latest->kind(), derived)) {
				latest = shared_ptr<Object>(new Object);
				latest->set(derived);
			}
			result = latest;
		}
		return result;
	}
};
using SharedConstants = SharedObject<JKRWadaConstants, KindOfPair>;
using SharedBonds = SharedObject<JKRWadaBond, contact_law::BondConstants<double>>;

class JKRWadaPhys : public NormShearPhys {
public:
	void setConstants(const shared_ptr<JKRWadaConstants>&);
	void setBond(const shared_ptr<JKRWadaBond>&);
	void endBond();
	void takeConstantsToCome();
	// All but the pointers. velocity: of the kernel's grain 1 past grain 2 through the last step. Against a plane the grain is body 2.
	void set(const contact_law::ContactGeometry<double>&, const contact_law::ContactForces<double>&, Real twist,
	        const Vector3r& velocity, const contact_law::DampingMoment<double>&, bool ofPlane = false);
	contact_law::ContactBefore before() const; // a step ago, for the next one
	Real storedEnergy() const;                 // [J]
	Real energyWhenTorn() const;               // that it gives up where a script tears the grains apart [J]
	// Springs that it had not in the last step.
	unsigned started(unsigned mechanisms) const { return mechanisms & contact_law::AllSprings & ~unsigned(springs); }
	virtual ~JKRWadaPhys() {}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(JKRWadaPhys, NormShearPhys,
		"State of a JKR-Wada contact. normalForce (elastic and viscous) and shearForce act on the second body; kn is the slope of "
		"the JKR force at equilibrium, ks the sliding stiffness.",
		((shared_ptr<JKRWadaConstants>, constants, , Attr::readonly, "Constants of this kind of pair."))
		((bool, touching, false, Attr::readonly, "Whether the grains adhere to each other."))
		((bool, bonded, false, Attr::readonly, "Whether this is a sintered bond, linear and elastic until it breaks, and not an "
			"ordinary contact."))
		((shared_ptr<JKRWadaBond>, bond, , Attr::readonly, "Constants of this kind of bond; None when it is none. Those in "
			"constants are of the contact that may take its place."))
		((Real, restDistance, 0, Attr::readonly, "Distance of the centres at which a bond was made [m]."))
		((shared_ptr<JKRWadaConstants>, constantsToCome, , Attr::readonly|Attr::hidden, "The constants from when its forces are next "
			"evaluated on (sinter(), set_material())."))
		((shared_ptr<JKRWadaBond>, bondToCome, , Attr::readonly|Attr::hidden, "Those of the bond that it is from then on."))
		((Vector3r, pointer1, Vector3r::Zero(), Attr::readonly, "Contact pointer of the first body, in the body's own frame: unit "
			"vector from its centre to the contact. Of a Wall: vector in its plane from its position to the contact [m]."))
		((Vector3r, pointer2, Vector3r::Zero(), Attr::readonly, "Contact pointer of the second body, likewise."))
		((Real, overlap, 0, Attr::readonly, "delta = r1 + r2 - distance of the centres [m], r1 and r2 as in constants; negative "
			"when the neck is stretched. Of a bond: restDistance - distance."))
		((Vector3r, slidingDisplacement, Vector3r::Zero(), Attr::readonly, "zeta [m]."))
		((Vector3r, rollingDisplacement, Vector3r::Zero(), Attr::readonly, "xi [m]."))
		((Real, twist, 0, Attr::readonly, "phi [rad]."))
		((Real, dragForce, 0, Attr::readonly, "Viscous part of the normal force, positive when the grains approach [N]."))
		((Vector3r, velocity, Vector3r::Zero(), Attr::readonly|Attr::hidden, "Velocity of body 1 past body 2 through the last "
			"step [m/s]."))
		((Vector3r, slidingRate, Vector3r::Zero(), Attr::readonly|Attr::hidden, "Of damped springs: how fast zeta grew through "
			"the last step [m/s]."))
		((Vector3r, turningRate, Vector3r::Zero(), Attr::readonly|Attr::hidden, "How fast the grains turned against each other, "
			"but for slips [rad/s]."))
		((Vector3r, slidingRateNow, Vector3r::Zero(), Attr::readonly|Attr::hidden, "The first at this moment."))
		((Vector3r, turningRateNow, Vector3r::Zero(), Attr::readonly|Attr::hidden, "The second at this moment."))
		((int, springs, int(contact_law::AllSprings), Attr::readonly|Attr::hidden, "Its springs in the last step (bits of "
			"Mechanism, kernel/contact_state.hpp)."))
		((bool, current, false, Attr::readonly|Attr::hidden, "Whether all this is of the moment that the bodies' positions are of "
			"(written by JKRWadaEngine), not of a step before.")),
		createIndex();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(JKRWadaPhys, NormShearPhys);
};
REGISTER_SERIALIZABLE(JKRWadaPhys);

/* All contacts of the scene become bonds of this neck when their forces are next evaluated, or a run of the fused engine takes them:
 * without strain where the grains are then. Existing bonds keep their own neck; grains shrink by the largest one. Contacts that a
 * script has torn apart stay what they are. */
void sinterContacts(const Scene&, const contact_law::PairOptions&, Real neck, Real largestNeck, SharedConstants&, SharedBonds&);

// Of the settings that functors and fused engine have in common; throw std::invalid_argument.
void requireInRange(const contact_law::PairOptions&, Real neck);
contact_law::LimitRule limitRuleOf(const std::string& name);

class Ip2_JKRMat_JKRMat_JKRWadaPhys : public IPhysFunctor {
	SharedConstants constants;
	SharedBonds bonds;

	contact_law::PairOptions options() const { return { CONTACT_LAW_PAIR_OPTIONS(CONTACT_LAW_VALUE) }; }
	void requireInRange(const JKRMat& material1, Real radius1, const JKRMat& material2, Real radius2) const;
	void requireSameMaterials(const JKRWadaPhys&, const JKRMat& material1, const JKRMat& material2, const Interaction&) const;

public:
	// Throws std::invalid_argument: within a step, YADE's threads could not pass an exception on.
	void postLoad(Ip2_JKRMat_JKRMat_JKRWadaPhys&);
	void go(const shared_ptr<Material>& material1, const shared_ptr<Material>& material2,
	        const shared_ptr<Interaction>& interaction) override;
	void sinter(Real neck);
	void setMaterial(const shared_ptr<JKRMat>& material, const shared_ptr<JKRMat>& as);
	boost::python::dict pairConstants(
	        const shared_ptr<JKRMat>& material1, Real radius1, const shared_ptr<JKRMat>& material2, Real radius2) const;
	boost::python::dict bondConstants(
	        const shared_ptr<JKRMat>& material1, Real radius1, const shared_ptr<JKRMat>& material2, Real radius2) const;
	virtual ~Ip2_JKRMat_JKRMat_JKRWadaPhys() {}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(Ip2_JKRMat_JKRMat_JKRWadaPhys, IPhysFunctor,
		"Makes a :yref:`JKRWadaPhys` from two :yref:`JKRMat` and the radii of the grains. With a neck, grains that touch at the "
		"start are sintered (Sirono & Ueno 2017): a linear elastic bond holds them "
		"until one of its modes has the energy pi a^2 gamma (a: the neck's radius). All other contacts are ordinary ones between "
		"grains that have shrunk by the volume of two necks each.",
		CONTACT_LAW_PAIR_OPTIONS(CONTACT_LAW_CHECKED_OPTION)
		((Real, neck, 0, Attr::triggerPostLoad, "Radius of the necks over that of the grains, up to 0.7 (unlike grains: over 2 r1 "
			"r2/(r1+r2)); 0: nothing is sintered."))
		((int, bondsBefore, 1, , "With a neck, contacts made while O.iter is below this are bonds: 1 for those that are there at "
			"the first step."))
		((Real, sinteredEarly, 0, Attr::readonly|Attr::hidden, "Neck of these bonds where sinter() was called before they were "
			"made: that of the first call, or the functor's before it; 0: neck.")),
		,
		.def("sinter", &Ip2_JKRMat_JKRMat_JKRWadaPhys::sinter, boost::python::arg("neck"),
			"All contacts become bonds of this neck when their forces are next evaluated, without strain where the grains are "
			"then; existing bonds keep their own neck. All grains shrink by the largest neck, which "
			"is this functor's neck from then on. What the contacts held is booked as disconnection. contact_law.sinter() "
			"calls this, or the fused engine's.")
		.def("setMaterial", &Ip2_JKRMat_JKRMat_JKRWadaPhys::setMaterial, (boost::python::arg("material"), boost::python::arg("like")),
			"A material gets the constants of another one, and all contacts the constants of their materials when their "
			"forces are next evaluated: contact_law.set_material() calls this, or the fused engine's.")
		.def("pairConstants", &Ip2_JKRMat_JKRMat_JKRWadaPhys::pairConstants,
			(boost::python::arg("material1"), boost::python::arg("radius1"), boost::python::arg("material2"), boost::python::arg("radius2")),
			"Constants of a contact of two grains (materials, radii in m) as a dict with the attributes of JKRWadaConstants. "
			"ValueError when a radius or a material constant is out of range. With a neck: of the shrunk grains (given are "
			"the radii before).")
		.def("bondConstants", &Ip2_JKRMat_JKRMat_JKRWadaPhys::bondConstants,
			(boost::python::arg("material1"), boost::python::arg("radius1"), boost::python::arg("material2"), boost::python::arg("radius2")),
			"Constants of a bond of two grains (radii before sintering) as a dict with the attributes of JKRWadaBond. "
			"ValueError likewise, or when there is no neck.")
	);
	// clang-format on
	FUNCTOR2D(JKRMat, JKRMat);
};
REGISTER_SERIALIZABLE(Ip2_JKRMat_JKRMat_JKRWadaPhys);

class Law2_ScGeom_JKRWadaPhys_JKRWada : public LawFunctor {
	EnergyChannels channels;
	contact_law::LimitRule limitRule = contact_law::LimitRule::Held;

	SceneShapes shapes;

	unsigned mechanismsOf(const contact_law::PairConstants<double>&) const;
	bool stepIsBelow(Real unstable) const;                              // refuses the scene in this step if not
	bool isWithin(const Interaction&, Real overlap, Real radius) const; // likewise
	bool goPlane(const GenericSpheresContact&, JKRWadaPhys&, const contact_law::PairConstants<double>&, const Interaction&);
	bool finish(const Interaction&, JKRWadaPhys&, const contact_law::ContactMotion&, Real twist, unsigned mechanisms,
	        const contact_law::ContactStepResult&);
	void sinter(JKRWadaPhys&, const contact_law::ContactMotion&, contact_law::ContactHistory<double>&, contact_law::ContactStepResult&);
	template <class Step>
	void changeConstants(JKRWadaPhys&, contact_law::ContactMotion, const contact_law::ContactBefore&, Real twist,
	        contact_law::ContactStepResult&, const Step&);
	contact_law::ContactStepResult bondStep(JKRWadaPhys&, const contact_law::PairConstants<double>&, contact_law::ContactMotion,
	        const contact_law::ContactBefore&, contact_law::ContactHistory<double>&, unsigned mechanisms);

public:
	void postLoad(Law2_ScGeom_JKRWadaPhys_JKRWada&); // throws std::invalid_argument
	bool go(shared_ptr<IGeom>& geometry, shared_ptr<IPhys>& physics, Interaction* interaction) override;
	virtual ~Law2_ScGeom_JKRWadaPhys_JKRWada() {}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(Law2_ScGeom_JKRWadaPhys_JKRWada, LawFunctor,
		"JKR normal force, Wada's sliding, rolling and twisting springs with their limits, and viscous drag, between grains of "
		"any radii and materials, and between grains and planes (Wall). "
		"Contacts that form or break inside a step are located in time. With O.trackEnergy the energies are in O.energy: those "
		"stored now, "
		"and what was dissipated since the start by slips, connection and disconnection of contacts, drag and the breaking of "
		"bonds (contact_law.channels has all names). "
		"O.energy['kinetic'] is brought from half a step ago, where NewtonIntegrator takes it, to the moment of the stored "
		"energies, so that the sum is constant. Use NewtonIntegrator(damping=0).",
		((bool, sliding, true, , "Whether contacts resist sliding."))
		((bool, rolling, true, , "Whether contacts resist rolling."))
		((bool, twisting, true, , "Whether contacts resist twisting."))
		((std::string, limit, contact_law::limitRuleNames[0], Attr::triggerPostLoad, "What happens to sliding, rolling and "
			"twisting springs of ordinary contacts at their limits. 'held': the displacement is held there (Wada et al. "
			"2007). 'cut': the spring is cut, what it stores is lost, and a new one without strain takes its place (Sirono & "
			"Ueno 2017)."))
		((int, brokenByStretching, 0, Attr::readonly, "Sintered bonds that have broken because they were stretched or pressed."))
		((int, brokenBySliding, 0, Attr::readonly, "Sintered bonds that have broken by sliding."))
		((int, brokenByRolling, 0, Attr::readonly, "Sintered bonds that have broken by rolling."))
		((int, brokenByTwisting, 0, Attr::readonly, "Sintered bonds that have broken by twisting."))
	);
	// clang-format on
	FUNCTOR2D(ScGeom, JKRWadaPhys);
};
REGISTER_SERIALIZABLE(Law2_ScGeom_JKRWadaPhys_JKRWada);

} // namespace yade
