// Compiled once, included before every file that sees a YADE type: Boost and Eigen are nearly all of what the compiler has to read.
#include <lib/factory/ClassFactory.hpp>
#ifdef CONTACT_LAW_YADES_OWN_HEADERS
// They register every class in every file that includes them, which makes the compiler write constructors, virtual tables and Python properties of
// all of them: half a minute a file. YADE's libraries have registered them.
#pragma push_macro("REGISTER_FACTORABLE")
#undef REGISTER_FACTORABLE
#define REGISTER_FACTORABLE(name)
#endif
#include <core/Omega.hpp>
#include <core/Interaction.hpp>
#include <core/Scene.hpp>
#include <lib/serialization/Serializable.hpp>
#include <core/Dispatching.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/NormShearPhys.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/ScGeom.hpp>
#ifdef CONTACT_LAW_YADES_OWN_HEADERS
#pragma pop_macro("REGISTER_FACTORABLE")
#endif
