/* Many collisions side by side, a block of threads each: the library that yade_scripts/run/ensemble.py calls. nvcc compiles it for a GPU; g++ (-x c++) for
 * processors, where a thread takes one collision after another. With -DWHOLE large ones, one after another: all blocks, or threads, work on each. */
#include "step.hpp"
#include <cstring>
#include <memory>
#include <new>
#include <numeric>

namespace contact_law {
namespace gpu {
	namespace {

		// The mechanisms that are compiled; others run in YADE.
		constexpr bool isCompiled(int mechanisms) { return mechanisms == AllSprings || mechanisms == Everything; }

		GPU void runAny(Collision& c, long long steps)
		{
			if (c.mechanisms == AllSprings)
				c.limit == LimitRule::Held ? run<AllSprings, LimitRule::Held>(c, steps) : run<AllSprings, LimitRule::Cut>(c, steps);
			else
				c.limit == LimitRule::Held ? run<Everything, LimitRule::Held>(c, steps) : run<Everything, LimitRule::Cut>(c, steps);
		}

		struct Task {
			Collision* collision; // in the device's memory
			long long steps;
		};

		// ---- the two back ends ----

#ifdef __CUDACC__
		thread_local std::string error; // of its latest call that failed

		bool succeeded(cudaError_t result)
		{
			if (result != cudaSuccess) error = cudaGetErrorString(result), cudaGetLastError(); // which forgets it
			return result == cudaSuccess;
		}
		struct Memory { // on the device; of the stream's, since cudaMalloc() and cudaFree() wait for all launches
			char* data = nullptr;
			explicit Memory(std::size_t size) { succeeded(cudaMallocAsync(&data, size, cudaStreamLegacy)); }
			Memory(const Memory&) = delete;
			~Memory() { cudaFreeAsync(data, cudaStreamLegacy); }
		};
		bool upload(Memory& to, const void* from, std::size_t size)
		{
			return succeeded(cudaMemcpy(to.data, from, size, cudaMemcpyHostToDevice));
		}
		bool download(void* to, const Memory& from, std::size_t size)
		{
			return succeeded(cudaMemcpy(to, from.data, size, cudaMemcpyDeviceToHost));
		}
		__global__ void __launch_bounds__(threadsOfGroup, blocksSideBySide) runAll(const Task* tasks)
		{
#ifdef WHOLE
			runAny(*tasks->collision, tasks->steps);
#else
			runAny(*tasks[blockIdx.x].collision, tasks[blockIdx.x].steps);
#endif
		}
		int multiprocessors()
		{
			int found = 0;
			cudaDeviceGetAttribute(&found, cudaDevAttrMultiProcessorCount, 0);
			return found;
		}
		// Launches of several threads are side by side, and beside what is copied meanwhile.
		bool launch(const std::vector<Task>& tasks)
		{
			thread_local cudaStream_t stream = nullptr;
			if (!stream && !succeeded(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking))) return false;
			const std::size_t size = tasks.size() * sizeof(Task);
			Memory list(size);
			if (!list.data || !upload(list, tasks.data(), size)) return false;
			const Task* each = reinterpret_cast<const Task*>(list.data);
#ifdef WHOLE
			const int blocks = std::min(multiprocessors() * blocksSideBySide, mostGroups); // which wait for each other
			for (std::size_t k = 0; k < tasks.size(); ++k, ++each) {
				void* given[] = { &each };
				if (!succeeded(cudaLaunchCooperativeKernel(runAll, blocks, threadsOfGroup, given, 0, stream))) return false;
			}
#else
			runAll<<<int(tasks.size()), threadsOfGroup, 0, stream>>>(each);
#endif
			return succeeded(cudaGetLastError()) && succeeded(cudaStreamSynchronize(stream));
		}
		std::string deviceName()
		{
			cudaDeviceProp properties;
			return succeeded(cudaGetDeviceProperties(&properties, 0)) ? properties.name : "";
		}
		int computedAtOnce() { return mostGroups > 1 ? 1 : multiprocessors() * blocksSideBySide; }
#else
		thread_local std::string error;

		struct Memory {
			char* data;
			explicit Memory(std::size_t size)
			        : data(static_cast<char*>(::operator new(size, std::align_val_t(64))))
			{
			}
			Memory(const Memory&) = delete;
			~Memory() { ::operator delete(data, std::align_val_t(64)); }
		};
		bool upload(Memory& to, const void* from, std::size_t size) { return std::memcpy(to.data, from, size); }
		bool download(void* to, const Memory& from, std::size_t size) { return std::memcpy(to, from.data, size); }
		bool launch(const std::vector<Task>& tasks)
		{
#ifdef WHOLE
#pragma omp parallel num_threads(std::min(omp_get_max_threads(), mostThreads))
			for (const Task& task : tasks)
				runAny(*task.collision, task.steps);
#else
			const int most = int(std::min<std::size_t>(tasks.size(), omp_get_max_threads()));
#pragma omp parallel for schedule(dynamic, 1) num_threads(most)
			for (const Task& task : tasks)
				runAny(*task.collision, task.steps);
#endif
			return true;
		}
		std::string deviceName() { return "processor"; }
		int computedAtOnce() { return mostGroups > 1 ? 1 : omp_get_max_threads(); }
#endif

		// A collision in the device's memory: the structure, then its arrays.
		constexpr std::size_t headSize = (sizeof(Collision) + 63) / 64 * 64;

		struct Held {
			std::size_t size;
			Memory device;
			std::vector<char> copy; // as it was read last

			Held(std::size_t size_)
			        : size(size_)
			        , device(size_)
			        , copy(size_)
			{
			}
			Collision& head() { return *reinterpret_cast<Collision*>(copy.data()); }
			// Its arrays as pointers into the copy.
			Collision& read()
			{
				place(head(), copy.data() + headSize);
				return head();
			}
			bool write()
			{
				place(head(), device.data + headSize);
				return upload(device, copy.data(), size);
			}
		};

		void copyVectors(const double* from, int count, Vectors to)
		{
			for (int k = 0; k < count; ++k)
				to.x[k] = from[3 * k], to.y[k] = from[3 * k + 1], to.z[k] = from[3 * k + 2];
		}
		void copyVectors(const Vectors& from, int count, double* to)
		{
			for (int k = 0; k < count; ++k)
				to[3 * k] = from.x[k], to[3 * k + 1] = from.y[k], to[3 * k + 2] = from.z[k];
		}
	}
}
}

// ---- what Python calls. Pointers are numpy's arrays; a returned 0 (null) means failure, and ensemble_error() says why ----

using namespace contact_law;
using namespace contact_law::gpu;

extern "C" {

// Of a collision at its start; vectors (N, 3), pairs (M, 2).
struct CollisionInput {
	int grains, contacts, kinds, bonded, mechanisms, limit, interval, slots, pairs, contactsOfAGrain, intervalAfter;
	long long steps, changesAt;
	double dt, dtAfter, neck, linearDamping, slidingStiffnessFactor, rollingStiffnessFactor, mixedSurfaceEnergyFactor, skin;
	const double *position, *velocity, *spin, *mass, *inertia, *radius, *materials;
	const int *kind, *aggregate, *touching;
};

const char* ensemble_error() { return error.c_str(); }
const char* ensemble_device()
{
	static std::string name;
	return (name = deviceName()).c_str();
}
int ensemble_at_once() { return computedAtOnce(); }
const char* ensemble_channels()
{
	static std::string names;
	names.clear();
	for (const Channel& channel : channels)
		names += (names.empty() ? "" : " ") + std::string(channel.name);
	return names.c_str();
}
int ensemble_runs(int mechanisms) { return isCompiled(mechanisms); }

void* collision_start(const CollisionInput* given)
{
	const CollisionInput& g = *given;
	Collision c {};
	c.room = { g.grains, g.slots, g.pairs, g.contactsOfAGrain, g.kinds, int(g.steps / std::min(g.interval, g.intervalAfter)) + 2 };
	c.grains = g.grains, c.mechanisms = g.mechanisms, c.limit = LimitRule(g.limit), c.interval = g.interval;
	c.bonds = g.bonded ? g.contacts : 0, c.slots = g.contacts, c.stepsLeft = g.steps;
	c.changesAt = g.changesAt, c.intervalAfter = g.intervalAfter, c.dtAfter = g.dtAfter;
	c.dt = g.dt, c.neck = g.neck, c.skin = g.skin;
	c.cellWidth = 2 * *std::max_element(g.radius, g.radius + g.grains) + g.skin;
	c.options = { g.linearDamping, g.slidingStiffnessFactor, g.rollingStiffnessFactor, 0, g.mixedSurfaceEnergyFactor };
	c.uniform = true;
	for (int k = 1; k < g.grains; ++k)
		c.uniform = c.uniform && g.radius[k] == g.radius[0] && g.kind[k] == g.kind[0];

	auto held = std::make_unique<Held>(headSize + place(c, nullptr));
	if (!held->device.data) return nullptr;
	held->head() = c;
	Collision& all = held->read();
	copyVectors(g.position, g.grains, all.position), copyVectors(g.velocity, g.grains, all.velocity);
	copyVectors(g.spin, g.grains, all.spin);
	std::copy_n(g.mass, g.grains, all.mass), std::copy_n(g.inertia, g.grains, all.inertia), std::copy_n(g.radius, g.grains, all.radius);
	std::copy_n(g.kind, g.grains, all.kind), std::copy_n(g.aggregate, g.grains, all.aggregate);
	std::memcpy(all.material, g.materials, g.kinds * sizeof(Material));
	for (int k = 0; k < g.contacts; ++k)
		all.first[k] = g.touching[2 * k], all.second[k] = g.touching[2 * k + 1];
	const Material& m = all.material[all.kind[0]];
	all.common = deriveShrunkPair(m, g.radius[0], m, g.radius[0], c.options, c.neck);
	if (c.bonds) all.commonBond = deriveBond(m, g.radius[0], m, g.radius[0], c.options, c.neck);
	return held->write() ? held.release() : nullptr;
}

void collision_end(void* collision) { delete static_cast<Held*>(collision); }

// So many steps of each, or as many as it has left: those with most work (steps times slots) first, since the last to end are alone.
int ensemble_run(void* const* collisions, int count, const long long* steps)
{
	std::vector<int> order(count);
	std::iota(order.begin(), order.end(), 0);
	const auto work = [&](int k) { return steps[k] * static_cast<Held*>(collisions[k])->head().slots; };
	std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return work(a) > work(b); });
	std::vector<Task> tasks;
	for (const int k : order)
		tasks.push_back({ reinterpret_cast<Collision*>(static_cast<Held*>(collisions[k])->device.data), steps[k] });
	return launch(tasks);
}

// Where a collision is, in numbers: steps made, steps left, samples, slots, failure.
int collision_read(void* collision, long long* numbers)
{
	Held& held = *static_cast<Held*>(collision);
	if (!download(held.copy.data(), held.device, headSize + held.head().sizeLookedAt)) return 0;
	const Collision& c = held.read();
	const long long found[] = { c.step, c.stepsLeft, c.samples, c.slots, (long long)(c.failure) };
	std::copy(std::begin(found), std::end(found), numbers);
	return 1;
}

// As it was read last: grains at the latest sample (N, 3), slots (S, 2) with their state and normal force, samples as rows of numbers.
void collision_grains(void* collision, double* position, double* velocity, double* spin)
{
	const Collision& c = static_cast<Held*>(collision)->read();
	copyVectors(c.position, c.grains, position), copyVectors(c.velocityNow, c.grains, velocity), copyVectors(c.spinNow, c.grains, spin);
}
void collision_slots(void* collision, int* grains, int* state, double* force)
{
	const Collision& c = static_cast<Held*>(collision)->read();
	for (int k = 0; k < c.slots; ++k)
		grains[2 * k] = c.first[k], grains[2 * k + 1] = c.second[k], state[k] = c.state[k], force[k] = c.normalForce[k];
}
void collision_samples(void* collision, double* rows)
{
	const Collision& c = static_cast<Held*>(collision)->read();
	for (int k = 0; k < c.samples; ++k) {
		const Sample& s = c.sample[k];
		*rows++ = s.time;
		for (const double energy : byChannel(s.energies))
			*rows++ = energy;
		for (const double count : { s.contacts, s.between, s.formed, s.broken })
			*rows++ = count;
		rows = std::copy(std::begin(s.brokenBonds), std::end(s.brokenBonds), rows);
		for (const Side& side : { s.right, s.left })
			for (const double sum : { side.grains, side.position, side.velocity })
				*rows++ = sum;
	}
}
// The whole state now, for a checkpoint: of the same build and device.
long long collision_size(void* collision) { return static_cast<Held*>(collision)->size; }
int collision_save(void* collision, char* to)
{
	const Held& held = *static_cast<Held*>(collision);
	return download(to, held.device, held.size);
}
void* collision_resume(const char* from, long long size)
{
	auto held = std::make_unique<Held>(size);
	if (!held->device.data) return nullptr;
	std::memcpy(held->copy.data(), from, size);
	return held->write() ? held.release() : nullptr;
}
}
