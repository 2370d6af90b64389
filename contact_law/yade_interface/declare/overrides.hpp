/* What every YADE class overrides. All are exported by YADE's libraries, so there are no bodies; the first of them also tells the compiler
   that the class's virtual table is elsewhere. */
#pragma once
#define YADE_INTERFACE_OVERRIDES_(Class)                                                                                                   \
public:                                                                                                                                    \
	std::string getBaseClassName(unsigned int = 0) const override;                                                                     \
	int getBaseClassNumber() const override;                                                                                           \
	std::string getClassName() const override;                                                                                         \
	void pySetAttr(const std::string& key, const boost::python::object& value) override;                                               \
	boost::python::dict pyDict() const override;                                                                                       \
	void callPostLoad() override;                                                                                                      \
	void pyRegisterClass(boost::python::object) override;                                                                              \
	SAVED_BY_YADE_MEMBER                                                                                                               \
public:
// The second level of indexed classes (ElastMat, Sphere, NormShearPhys, ...).
#define YADE_INTERFACE_INDEX_OVERRIDES_                                                                                                    \
	int& modifyClassIndex() override;                                                                                                  \
	const int& getClassIndex() const override;                                                                                         \
	const int& getBaseClassIndex(int depth) const override;
