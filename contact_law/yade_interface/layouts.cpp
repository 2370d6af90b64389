/* Where YADE's objects hold what the plugin reads and writes, in bytes: the same in the described versions 2023.02a, 2025.2.0 and 2026.1.0.
 * An ordinary build holds the declarations of this folder to these numbers; `make yade-tree` holds the headers of YADE's own source to them. */
#include "yade.hpp"
#include <cstddef>
#include <pthread.h>

#pragma GCC diagnostic ignored "-Winvalid-offsetof" // well defined by the compilers that build YADE

#define SIZE(Class, bytes) static_assert(sizeof(Class) == (bytes), #Class " has another size in YADE")
#define AT(Class, member, bytes) static_assert(offsetof(Class, member) == (bytes), #Class "." #member " stands elsewhere in YADE")

namespace yade {

// Two things differ between processors: a mutex has 40 bytes on x86 and 48 on 64-bit ARM, where Debian's YADE is built without MPI.
constexpr std::size_t mutexSize = sizeof(pthread_mutex_t);
#ifdef YADE_MPI
constexpr std::size_t subdomainSize = 24;
#else
constexpr std::size_t subdomainSize = 0;
#endif

SIZE(Real, 8);
SIZE(Vector3r, 24);
SIZE(Vector3i, 12);
SIZE(Matrix3r, 72);
SIZE(Quaternionr, 32);
SIZE(Se3r, 56);
SIZE(Serializable, 24);
SIZE(Indexable, 8);

SIZE(Material, 80);
AT(Material, density, 72);
SIZE(ElastMat, 96);
AT(ElastMat, young, 80);
AT(ElastMat, poisson, 88);

SIZE(State, 280 + mutexSize);
AT(State, se3, 48 + mutexSize);
AT(State, vel, 104 + mutexSize);
AT(State, mass, 128 + mutexSize);
AT(State, angVel, 136 + mutexSize);
AT(State, inertia, 184 + mutexSize);
AT(State, blockedDOFs, 264 + mutexSize);

SIZE(Shape, 96);
SIZE(Sphere, 104);
AT(Sphere, radius, 96);
SIZE(Wall, 104);
AT(Wall, sense, 92);
AT(Wall, axis, 96);

SIZE(Body, 176);
AT(Body, id, 24);
AT(Body, groupMask, 28);
AT(Body, flags, 32);
AT(Body, material, 40);
AT(Body, state, 56);
AT(Body, shape, 72);
AT(Body, clumpId, 152);

SIZE(IGeom, 32);
SIZE(ScGeom, 192);
AT(ScGeom, normal, 32);
AT(ScGeom, contactPoint, 56);
AT(ScGeom, refR1, 80);
AT(ScGeom, refR2, 88);
AT(ScGeom, penetrationDepth, 160);

SIZE(IPhys, 32);
SIZE(NormPhys, 64);
AT(NormPhys, kn, 32);
AT(NormPhys, normalForce, 40);
SIZE(NormShearPhys, 96);
AT(NormShearPhys, ks, 64);
AT(NormShearPhys, shearForce, 72);

SIZE(Interaction, 168);
AT(Interaction, id1, 88);
AT(Interaction, id2, 92);
AT(Interaction, iterMadeReal, 96);
AT(Interaction, geom, 112);
AT(Interaction, phys, 128);
AT(Interaction, cellDist, 144);
AT(Interaction, iterBorn, 160);

// Public members behind the private ones that the plugin reads too.
SIZE(BodyContainer, 136 + mutexSize + subdomainSize);
AT(BodyContainer, dirty, 48);
SIZE(InteractionContainer, 152 + mutexSize);
AT(InteractionContainer, dirty, 128);

SIZE(ForceContainer, 264 + mutexSize);
SIZE(EnergyTracker, 176);
AT(EnergyTracker, names, 88);

SIZE(Cell, 1104);
AT(Cell, trsf, 592);
AT(Cell, hSize, 736);
AT(Cell, prevHSize, 808);
AT(Cell, velGrad, 880);
AT(Cell, nextVelGrad, 952);
AT(Cell, prevVelGrad, 1024);
AT(Cell, homoDeform, 1096);
AT(Cell, velGradChanged, 1100);

SIZE(Scene, 688 + mutexSize + subdomainSize);
AT(Scene, forces, 32);
AT(Scene, dt, 400 + mutexSize);
AT(Scene, iter, 408 + mutexSize);
AT(Scene, subStep, 420 + mutexSize);
AT(Scene, time, 424 + mutexSize);
AT(Scene, stopAtIter, 440 + mutexSize);
AT(Scene, isPeriodic, 456 + mutexSize);
AT(Scene, trackEnergy, 457 + mutexSize);
AT(Scene, tags, 464 + mutexSize + subdomainSize);
AT(Scene, engines, 488 + mutexSize + subdomainSize);
AT(Scene, _nextEngines, 512 + mutexSize + subdomainSize);
AT(Scene, bodies, 536 + mutexSize + subdomainSize);
AT(Scene, interactions, 552 + mutexSize + subdomainSize);
AT(Scene, energy, 568 + mutexSize + subdomainSize);
AT(Scene, cell, 624 + mutexSize + subdomainSize);

SIZE(Engine, 104);
AT(Engine, scene, 24);
AT(Engine, dead, 64);
SIZE(GlobalEngine, 104);
SIZE(Functor, 80);
AT(Functor, scene, 40);
SIZE(IPhysFunctor, 88);
SIZE(LawFunctor, 88);

} // namespace yade
