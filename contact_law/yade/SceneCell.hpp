// O.cell for the fused engine: the periodic cell that YADE's Scene deforms at the beginning of each O.step, and its mean velocity field.
#pragma once
#include "../engine/dynamics.hpp"
#include <core/Scene.hpp>
#include <string>

namespace yade {

enum class Moment { BetweenSteps, WithinStep }; // of O.step

class SceneCell {
public:
	/* The cell at the start's moment. Within an O.step the Scene has deformed it already, and the start is before that. `stepBehind`: the contacts are the
	 * functors', who leave the cell a small step (dt, s) behind the grains; O.cell is brought to them. Throws std::runtime_error for a cell that is no box. */
	contact_law::PeriodicCell start(Scene&, Moment, bool stepBehind, Real dt);

	/* Before a step: refuses, in one line, a cell that this engine cannot follow. After it the cell is of size now(). */
	void require(const Scene&, const contact_law::Dynamics&) const;
	// Empty, or why the grains cannot go in so many small steps to the cell as it is now.
	std::string wrong(const Scene&, const contact_law::Dynamics&, int steps) const;
	static std::string tooSmall(const contact_law::PeriodicCell&, const contact_law::Dynamics&); // likewise, of its size only
	void arrive(const Scene& scene) { size = now(scene); }

	// Grains get the change of the velocity gradient since they got the last, when Cell.homoDeform says so.
	static void applyVelocityGradient(Scene&, contact_law::Dynamics&);
	// Before that, the velocity gradient that a script wants becomes the present one, as NewtonIntegrator does it.
	static void takeVelocityGradient(Scene&, contact_law::Dynamics&);

	// Takes back, for a step that is refused, how the Scene has deformed the cell at its beginning.
	class Before {
	public:
		explicit Before(const Scene&);
		void restore(Scene&) const;

	private:
		Matrix3r size, transformation;
	};

	static contact_law::Vec3<double> now(const Scene&);
	// Diagonal of the gradient whose convective acceleration grains have [1/s].
	static contact_law::Vec3<double> convective(const Scene&);

private:
	contact_law::Vec3<double> size { 0, 0, 0 }; // that the engine's run has reached [m]
};

} // namespace yade
