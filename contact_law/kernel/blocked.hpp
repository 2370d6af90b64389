// Degrees of freedom along which a grain does not answer to forces: bits 1, 2, 4 for x, y, z and 8, 16, 32 for turning about them, as in
// YADE's State.blockedDOFs.
#pragma once
#include "numbers.hpp"
#include <array>

namespace contact_law {

// The components whose bits (1, 2, 4) are set; the others zero.
inline Vec3<double> componentsOf(const Vec3<double>& v, unsigned bits)
{
	return { bits & 1 ? v.x : 0, bits & 2 ? v.y : 0, bits & 4 ? v.z : 0 };
}

inline Vec3<double> blockedForce(const Vec3<double>& force, unsigned blocked) { return componentsOf(force, blocked & 7); }
inline Vec3<double> blockedTorque(const Vec3<double>& torque, unsigned blocked) { return componentsOf(torque, blocked >> 3 & 7); }

// 1 for each degree of freedom that is blocked, 0 for the others: x, y, z, about x, y, z.
using BlockedRow = std::array<double, 6>;
constexpr std::array<BlockedRow, 64> allBlockedRows()
{
	std::array<BlockedRow, 64> rows {};
	for (unsigned bits = 0; bits < rows.size(); ++bits)
		for (unsigned k = 0; k < 6; ++k)
			rows[bits][k] = bits >> k & 1;
	return rows;
}
constexpr auto blockedRows = allBlockedRows();

// 1/inertia that a torque meets: none turns a grain whose turning is blocked about all axes.
inline double inverseInertiaOf(double inverseInertia, unsigned blocked) { return (blocked >> 3 & 7) == 7 ? 0 : inverseInertia; }

// 1/mass that an impulse along a direction (of any length) meets: an impulse J adds J^2/2 of it to the kinetic energy of a grain at rest.
inline double inverseMassAlong(const Vec3<double>& direction, double inverseMass, unsigned blocked)
{
	if (!(blocked & 7)) return inverseMass;
	const Vec3<double> free = componentsOf(direction, ~blocked & 7);
	return inverseMass * dot(free, free) / dot(direction, direction);
}

} // namespace contact_law
