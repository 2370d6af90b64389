// The kernel's functions for Python (ctypes): plain arrays in, plain arrays out. Built by conftest.py.
#include "../../contact_law/kernel/bond.hpp"

using namespace contact_law;

namespace {
Vec3<double> vector(const double* p) { return { p[0], p[1], p[2] }; }
void write(double*& out, const Vec3<double>& v) { *out++ = v.x, *out++ = v.y, *out++ = v.z; }
// constants in the order of their lists
PairConstants<double> constantsFrom(const double* p)
{
	PairConstants<double> c;
	for (const auto& constant : pairConstantsOf<double>)
		c.*constant.member = *p++;
	return c;
}
BondConstants<double> bondFrom(const double* p)
{
	BondConstants<double> b;
	for (const auto member : bondConstantsOf<double>)
		b.*member = *p++;
	return b;
}
Material material(const double* p) { return { p[0], p[1], p[2], p[3], p[4], p[5] }; }
} // namespace

extern "C" {

#define NAME(name, ...) #name " "
const char* constantNames() { return CONTACT_LAW_PAIR_CONSTANTS(NAME) "inverseEquilibriumOverlap"; }
const char* bondConstantNames() { return CONTACT_LAW_BOND_CONSTANTS(NAME); }

void pairConstants(const double* material1, double radius1, const double* material2, double radius2, double linearDamping,
        double slidingStiffnessFactor, double rollingStiffnessFactor, double springDamping, double mixedSurfaceEnergyFactor, double* out)
{
	const PairOptions options { linearDamping, slidingStiffnessFactor, rollingStiffnessFactor, springDamping,
		mixedSurfaceEnergyFactor };
	const PairConstants<double> c = derivePair(material(material1), radius1, material(material2), radius2, options);
	for (const auto& constant : pairConstantsOf<double>)
		*out++ = c.*constant.member;
}

void normalLaw(int n, const double* overlap, double* u, double* force, double* energy)
{
	for (int i = 0; i < n; ++i) {
		u[i] = normal::rootOfContactRadius(overlap[i]);
		force[i] = normal::force(u[i]);
		energy[i] = normal::energy(u[i]);
	}
}

// state: separation, n1, n2, velocity (12 numbers), twist. out: force on 1 (without drag), drag, torque1, torque2, the four stored energies.
void contactAt(const double* constants, const double* state, double* out)
{
	const auto c = constantsFrom(constants);
	const ContactHistory<double> h { { vector(state + 3), vector(state + 6) }, state[12] };
	const ContactGeometry<double> g = geometryOf(vector(state), c.radius1 + c.radius2);
	const ContactForces<double> f = contactForces<Everything>(c, g, h, vector(state + 9));
	const StoredEnergy<double> e = storedEnergy(AllSprings, c, f, h.twist);
	write(out, f.normalForce * g.normal + f.sliding);
	*out++ = f.drag;
	write(out, f.torque1);
	write(out, f.torque2);
	*out++ = e.normal, *out++ = e.sliding, *out++ = e.rolling, *out++ = e.twisting;
}

// pointers: n1, n2, replaced by those with the displacement returned to the limit. which: 0 sliding, 1 rolling.
void returnToLimit(const double* constants, const double* normalVector, double* pointers, int which, double limit)
{
	const auto c = constantsFrom(constants);
	Pointers<double> p { vector(pointers), vector(pointers + 3) };
	if (which == 0)
		p = returned<SlidingSpring>(c, p, SlidingSpring::displacement(c, p, vector(normalVector)), limit);
	else
		p = returned<RollingSpring>(c, p, RollingSpring::displacement(c, p), limit);
	write(pointers, p.n1);
	write(pointers, p.n2);
}

double cubeRootOf(double x) { return cubeRoot(x); }

// out: fillet radius, length, volume, radius of the shrunk grain, all relative to the grain
void neckGeometry(double beta, double* out)
{
	out[0] = neck::filletRadius(beta), out[1] = neck::length(beta), out[2] = neck::volume(beta), out[3] = neck::shrunkRadius(beta);
}

void bondConstants(const double* material1, double radius1, const double* material2, double radius2, double beta, double* out)
{
	const BondConstants<double> b = deriveBond(material(material1), radius1, material(material2), radius2, {}, beta);
	for (const auto member : bondConstantsOf<double>)
		*out++ = b.*member;
}

// state: separation, n1, n2 (9 numbers), twist. out: force on 1, torque1, torque2, the four stored energies.
void bondAt(const double* constants, double rest, const double* state, double* out)
{
	const auto b = bondFrom(constants);
	const ContactHistory<double> h { { vector(state + 3), vector(state + 6) }, state[9] };
	const ContactGeometry<double> g = geometryOf(vector(state), rest);
	const ContactForces<double> f = bondForces(b, g, h);
	const StoredEnergy<double> e = bondEnergy(b, g, f, h.twist);
	write(out, f.normalForce * g.normal + f.sliding);
	write(out, f.torque1);
	write(out, f.torque2);
	*out++ = e.normal, *out++ = e.sliding, *out++ = e.rolling, *out++ = e.twisting;
}

// out: displacement of the last spring, mean displacement of all over the way.
void cutPassage(const double* before, const double* trial, double limit, double* out)
{
	const auto passed = cut::passage(vector(before), vector(trial), limit);
	write(out, passed.now);
	write(out, passed.mean);
}

void turn(const double* v, const double* angle, double* out) { write(out, turned(vector(v), vector(angle))); }
}
