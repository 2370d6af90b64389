// What to say of a run that went wrong.
#include "dynamics.hpp"

namespace contact_law {

// In a step a grain may go half the smallest radius: beyond that two of them pass each other unseen, and forces have long lost their meaning.
double Dynamics::fastestAllowed() const { return 0.5 * smallestRadius() / setting.dt; }

Dynamics::Trouble Dynamics::trouble(int given) const
{
	const auto squared = [&](int k) { return dot(velocityOf(setting.grains[k]), velocityOf(setting.grains[k])); };
	int worst = given >= 0 ? indexHere[given] : 0;
	for (int k = 0; given < 0 && k < count; ++k)
		if (squared(k) > squared(worst)) worst = k;
	Trouble t;
	t.grain = original[worst];
	t.speed = std::sqrt(squared(worst));
	for (const auto& domain : domains)
		for (const ContactList& list : domain->contacts)
			for (int lane = 0; lane < list.size(); ++lane) {
				if (!list.alive(lane)) continue;
				if (list.first(lane) != worst && list.second(lane) != worst) continue;
				const Contact c = setting.contactOf(list, lane);
				// what pushed was the force where they were before they moved
				const Grain &a = setting.grains[c.i], &b = setting.grains[c.j];
				Vec3<double> d = separationOf(a, b) - setting.dt * (velocityOf(a) - velocityOf(b));
				nearestImage(cell(), d);
				const auto g = geometryOf(d, c.constants.radius1 + c.constants.radius2);
				const double f = contactForces<0>(c.constants, g, c.history, Vec3<double> {}).normalForce;
				if (t.other >= 0 && std::abs(f) <= std::abs(t.force)) continue;
				t.other = original[c.i == worst ? c.j : c.i];
				t.overlap = g.overlap / std::min(c.constants.radius1, c.constants.radius2);
				t.force = f;
			}
	eachBond([&](const Bond& b, int first, int second, double) {
		if (b.i != worst && b.j != worst) return;
		const Grain &one = setting.grains[b.i], &two = setting.grains[b.j];
		const Vec3<double> d = separationOf(one, two) - setting.dt * (velocityOf(one) - velocityOf(two));
		const double f = b.constants.normalStiffness * (b.rest - std::sqrt(dot(d, d)));
		if (t.other >= 0 && std::abs(f) <= std::abs(t.force)) return;
		t.other = b.i == worst ? second : first;
		t.overlap = (setting.radius[b.i] + setting.radius[b.j] - std::sqrt(dot(d, d)))
		        / std::min(setting.radius[b.i], setting.radius[b.j]);
		t.force = f;
	});
	return t;
}

Dynamics::Trouble Dynamics::hardest() const
{
	Trouble t;
	eachContact([&](const Contact& c, int first, int second, double force) {
		if (t.grain >= 0 && std::abs(force) <= std::abs(t.force)) return;
		Vec3<double> d = separationOf(setting.grains[c.i], setting.grains[c.j]);
		nearestImage(cell(), d);
		const double r1 = c.constants.radius1, r2 = c.constants.radius2;
		t = { std::min(first, second), std::max(first, second), 0, (r1 + r2 - std::sqrt(dot(d, d))) / std::min(r1, r2), force };
	});
	eachBond([&](const Bond& b, int first, int second, double force) {
		if (t.grain >= 0 && std::abs(force) <= std::abs(t.force)) return;
		const Vec3<double> d = separationOf(setting.grains[b.i], setting.grains[b.j]);
		const double r1 = setting.radius[b.i], r2 = setting.radius[b.j];
		t = { std::min(first, second), std::max(first, second), 0, (r1 + r2 - std::sqrt(dot(d, d))) / std::min(r1, r2), force };
	});
	return t;
}

Dynamics::Trouble Dynamics::tooDeep() const
{
	std::vector<Trouble> worst(domains.size());
#pragma omp parallel for num_threads(threadCount())
	for (std::size_t d = 0; d < domains.size(); ++d)
		worst[d] = tooDeep(*domains[d]);
	return *std::max_element(worst.begin(), worst.end(), [](const Trouble& a, const Trouble& b) { return a.overlap < b.overlap; });
}

Dynamics::Trouble Dynamics::tooDeep(const Domain& domain) const
{
	Trouble t;
	for (int sort = 0; sort < 2; ++sort) {
		const ContactList& list = domain.contacts[sort];
		for (int lane = 0; lane < list.size(); ++lane) {
			if (!list.alive(lane)) continue;
			const int i = list.first(lane), j = list.second(lane);
			Vec3<double> d = separationOf(setting.grains[i], setting.grains[j]);
			nearestImage(cell(), d);
			const double least = std::max(setting.radius[i], setting.radius[j]);
			if (dot(d, d) >= least * least) continue;
			const double overlap = (setting.radius[i] + setting.radius[j] - std::sqrt(dot(d, d)))
			        / std::min(setting.radius[i], setting.radius[j]);
			if (overlap <= t.overlap) continue;
			t = { std::min(original[i], original[j]), std::max(original[i], original[j]), 0, overlap, 0 };
		}
	}
	return t;
}

} // namespace contact_law
