// What JKRWadaEngine holds from its first step on, for its own files.
#pragma once
#include "JKRWadaEngine.hpp"
#include "SceneContacts.hpp"
#include "SceneForces.hpp"
#include "StepWatch.hpp"
#include <boost/weak_ptr.hpp>

namespace yade {

struct JKRWadaEngine::Run {
	SceneGrains grains;
	SceneContacts contacts;
	SceneCell cell;
	EngineSettings settings;            // at the start
	contact_law::Dynamics::Onset onset; // of the outside forces at the first step
	contact_law::Dynamics dynamics;
	boost::weak_ptr<Scene> scene; // whose grains these are
	std::string name;             // of this run, as ContactsHolder
	SceneForces forces {};
	std::vector<contact_law::GrainMotion> now {};
	StepWatch watch {};
	std::vector<contact_law::OutsideForce> outside {}; // by grains, as they are held
	EnergyChannels::WorkOn workOn {};                  // at any time: the scene then has the channel
};

} // namespace yade
