/* The planes of a scene (half-spaces, kernel/contact_step.hpp) and a domain's grains on them. Contacts go through a pass
 * of their own (plane_pass.hpp); those that form, break, or have springs cut, through the kernel's scalar law, as the functors' do. A plane
 * concerns the domain that has the grain and no other; each domain moves the planes on by itself, all by the same numbers. */
#pragma once
#include "../kernel/contact_step.hpp"
#include "ledger.hpp"

namespace contact_law {

class PlaneContacts {
public:
	PlaneContacts(SharedState&, Ledger&, int begin, int end); // of grains from `begin` up to, but not including, `end`

	std::vector<Vec3<double>> positions; // of the planes, of the latest forces' moment [m]
	std::vector<PlaneContact> contacts;  // by rising grain and plane
	std::vector<Vec3<double>> pushes;    // what own grains give each plane: their kicks of this moment over dt [N]

	void advance() // planes move on by a step
	{
		for (std::size_t p = 0; p < positions.size(); ++p)
			positions[p] = positions[p] + s.dt * s.planes[p].velocity;
	}
	// Forces on own grains, of contacts that are, form and break. velocities: of own grains through the latest drift.
	void addForces(const VelocityRange& velocities)
	{
		if (!positions.empty()) addForcesOfPlanes(velocities);
	}
	void outdate() { approach = 1e300; }          // grains or planes have been moved otherwise than by steps
	void moved(int plane, const Vec3<double>& to) // by its owner, which may have given it another velocity
	{
		positions[plane] = to;
		outdate();
		takeVelocities();
	}
	void place(const PlaneContact&); // if its grain is owned
	void takeVelocities();           // as they are now, for drag in the next step
	StoredEnergy<double> energies() const;
	// As one of own grains is now, drag as it was in the latest step.
	ContactGeometry<double> geometryOf(const PlaneContact&) const; // its normal: towards the grain
	ContactForces<double> forcesOf(const PlaneContact&) const;     // on the grain

	double work = 0;                                  // of grains on the planes [J]
	template <class Archive> void transfer(Archive&); // checkpoint.cpp

private:
	struct Near {
		int grain, plane;
	};
	bool owns(int grain) const { return grain >= begin && grain < end; }
	void addForcesOfPlanes(const VelocityRange&);
	void findNear();
	double distance(int grain, int plane) const; // with its sign
	PlaneContact newContact(int grain, int plane) const;
	Plane planeOf(const PlaneContact&) const;
	Vec3<double> footOf(const PlaneContact&) const;
	bool step(PlaneContact&);
	void add(const PlaneContact&, const Vec3<double>& force, const Vec3<double>& forceBefore, const Vec3<double>& torque);
	void stepAll();
	void formContacts();

	SharedState& s;
	Ledger& ledger;
	int begin, end;
	std::vector<Vec3<double>> after; // of the kicks of the latest step what belongs after their moment, by plane
	std::vector<Near> near;          // grains closer to a plane than the skin when they were looked for, by rising grain
	double approach = 1e300;         // bound on how far grains and planes have come closer since [m]
};

} // namespace contact_law
