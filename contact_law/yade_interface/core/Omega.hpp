// The running YADE. Its object lives in libyade and only exported functions are called: its layout doesn't matter here.
#pragma once
#include <core/Scene.hpp>

namespace yade {

class Omega : public Singleton<Omega> {
public:
	const shared_ptr<Scene>& getScene() const;
	bool isRunning(); // whether O.step() or O.run() is stepping in its thread
	// makes the named classes known to YADE and to yade.wrapper
	void buildDynlibDatabase(const std::vector<std::string>& classNames);
};

} // namespace yade
