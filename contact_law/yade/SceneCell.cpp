#include "JKRWadaEngineRun.hpp"
#include "Refusal.hpp"

namespace yade {

using contact_law::Dynamics;
using contact_law::PeriodicCell;
using Vec3d = contact_law::Vec3<double>;

namespace {
	Vec3d diagonal(const Matrix3r& m) { return { m(0, 0), m(1, 1), m(2, 2) }; }

	void requireDiagonal(const Matrix3r& m, const char* name, const char* what)
	{
		for (int i = 0; i < 3; ++i)
			for (int j = 0; j < 3; ++j)
				if (!std::isfinite(m(i, j)) || (i != j && m(i, j) != 0))
					refuseInEngine(std::string("O.cell.") + name + " has the element (" + std::to_string(i) + ", "
					        + std::to_string(j) + ") = " + text(m(i, j)) + ": must be " + what);
	}

	void requireBox(const Cell& cell)
	{
		requireDiagonal(cell.hSize, "hSize", "a box along the axes (diagonal)");
		const char* stretching =
		        "stretching along the axes (diagonal); for shear take YADE's own loop with this contact law, or grains "
		        "between two plates that slide (utils.wall)";
		requireDiagonal(cell.velGrad, "velGrad", stretching);
		requireDiagonal(cell.nextVelGrad, "velGrad", stretching);
	}

	std::string sizeText(Real length) { return rounded(length, 6); }
	std::string sizeText(const Vec3d& v) { return "(" + sizeText(v.x) + ", " + sizeText(v.y) + ", " + sizeText(v.z) + ")"; }
}

Vec3d SceneCell::now(const Scene& scene) { return scene.isPeriodic ? diagonal(scene.cell->hSize) : Vec3d { 0, 0, 0 }; }

Vec3d SceneCell::convective(const Scene& scene)
{
	return scene.isPeriodic && scene.cell->homoDeform == 2 ? diagonal(scene.cell->velGrad) : Vec3d { 0, 0, 0 };
}

PeriodicCell SceneCell::start(const Scene& scene, Moment moment)
{
	if (!scene.isPeriodic) return {};
	const Cell& cell = *scene.cell;
	requireBox(cell);
	const Matrix3r& before = moment == Moment::WithinStep ? cell.prevHSize : cell.hSize;
	size = diagonal(before);
	for (const Real length : { size.x, size.y, size.z })
		if (!(length > 0)) refuseInEngine("O.cell.hSize is " + sizeText(size) + " m: must be > 0");
	return PeriodicCell::box(size, diagonal(cell.velGrad * before));
}

void SceneCell::require(const Scene& scene, const Dynamics& dynamics) const
{
	if (scene.isPeriodic != dynamics.cell().on)
		refuseInEngine("O.periodic was changed after the start: it must stay " + text(dynamics.cell().on) + "; make a new engine");
	if (!scene.isPeriodic) return;
	requireBox(*scene.cell);
	const Vec3d was = diagonal(scene.cell->prevHSize);
	if (!(was == size))
		refuseInEngine("O.cell was given another size " + sizeText(was) + " m by a script, after the start with " + sizeText(size)
		        + " m: it must change by O.cell.velGrad only; or make a new engine");
}

std::string SceneCell::tooSmall(const PeriodicCell& cell, const Dynamics& dynamics)
{
	if (!cell.on || cell.holds(dynamics.reach())) return "";
	return "the periodic cell of " + sizeText(cell.size) + " m is too small: must be at least " + sizeText(2 * dynamics.reach())
	        + " m along each axis, twice the reach of a pair of grains";
}

std::string SceneCell::wrong(const Scene& scene, const Dynamics& dynamics, int steps) const
{
	if (!scene.isPeriodic) return "";
	const PeriodicCell cell = PeriodicCell::box(now(scene), {});
	const Vec3d change = cell.size - size;
	const Real most = 0.5 * dynamics.state().smallestRadius * steps;
	for (const Real way : { change.x, change.y, change.z })
		if (!(std::abs(way) <= most))
			return "the periodic cell changes to " + sizeText(cell.size)
			        + " m, by more than half the smallest radius in a small step";
	return tooSmall(cell, dynamics);
}

SceneCell::Before::Before(const Scene& scene)
{
	if (!scene.isPeriodic) return;
	const Cell& cell = *scene.cell;
	size = cell.prevHSize;
	transformation = (Matrix3r::Identity() + scene.dt * cell.velGrad).inverse() * cell.trsf;
}

void SceneCell::Before::restore(Scene& scene) const
{
	if (!scene.isPeriodic) return;
	scene.cell->hSize = size;
	scene.cell->trsf = transformation;
	scene.cell->integrateAndUpdate(0); // what is derived from them
}

void SceneCell::takeVelocityGradient(Scene& scene, Dynamics& dynamics)
{
	if (!scene.isPeriodic) return;
	Cell& cell = *scene.cell;
	if (cell.velGradChanged || cell.nextVelGrad != Matrix3r::Zero()) {
		cell.velGrad = cell.nextVelGrad;
		cell.velGradChanged = false;
		cell.nextVelGrad = Matrix3r::Zero();
	}
	applyVelocityGradient(scene, dynamics);
}

void SceneCell::applyVelocityGradient(Scene& scene, Dynamics& dynamics)
{
	if (!scene.isPeriodic) return;
	Cell& cell = *scene.cell;
	const Vec3d gradient = diagonal(cell.velGrad), none { 0, 0, 0 };
	dynamics.setMeanField(cell.homoDeform ? gradient - diagonal(cell.prevVelGrad) : none, convective(scene));
	cell.prevVelGrad = cell.velGrad;
}

} // namespace yade
