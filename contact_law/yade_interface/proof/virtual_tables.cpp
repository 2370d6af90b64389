/* The order of virtual functions, read from YADE's own objects: a call through a wrong slot would be a call of something else.
   The names are looked up, nothing is called. */
#include "layouts.hpp"
#include "safe_memory.hpp"
#include <core/Engine.hpp>

namespace contact_law {
namespace proof {

	namespace {
		struct Table {
			const char* className;
			size_t offset; // of the part of the object that uses the table
			int first;     // slot
			std::vector<const char*> functions;
		};

		const std::vector<Table> tables {
			{ "NormShearPhys", 0, 2,
			        { "getBaseClassName", "getBaseClassNumber", "getClassName", "pySetAttr", "pyDict", "pyDictCustom",
			                "callPostLoad", "checkPyClassRegistersItself", "pyRegisterClass", "pyHandleCustomCtorArgs",
			                "modifyClassIndex", "getClassIndex", "getBaseClassIndex", "getMaxCurrentlyUsedClassIndexOfKin",
			                "incrementMaxCurrentlyUsedClassIndexOfKin" } },
			{ "NormShearPhys", 24, 0,
			        { "incrementMaxCurrentlyUsedClassIndexOfKin", "modifyClassIndex", "D1Ev", "D0Ev", "getClassIndex",
			                "getBaseClassIndex", "getMaxCurrentlyUsedClassIndexOfKin" } },
			{ "ElastMat", 0, 2,
			        { "getBaseClassName", "getBaseClassNumber", "getClassName", "pySetAttr", "pyDict", "pyDictCustom",
			                "callPostLoad", "checkPyClassRegistersItself", "pyRegisterClass", "pyHandleCustomCtorArgs",
			                "newAssocState", "stateTypeOk", "modifyClassIndex", "getClassIndex", "getBaseClassIndex",
			                "getMaxCurrentlyUsedClassIndexOfKin", "incrementMaxCurrentlyUsedClassIndexOfKin" } },
			{ "ElastMat", 24, 0,
			        { "incrementMaxCurrentlyUsedClassIndexOfKin", "modifyClassIndex", "D1Ev", "D0Ev", "getClassIndex",
			                "getBaseClassIndex", "getMaxCurrentlyUsedClassIndexOfKin" } },
			{ "ForceResetter", 0, 11, { "pyHandleCustomCtorArgs", "isActivated", "action" } },
			{ "Ip2_FrictMat_FrictMat_FrictPhys", 0, 11,
			        { "pyHandleCustomCtorArgs", "getFunctorTypes", "get2DFunctorType1", "get2DFunctorType2", "2goE" } },
			{ "Ip2_FrictMat_FrictMat_FrictPhys", 80, 2,
			        { "checkOrder", "2goE", "2goE", "FrictMat_FrictPhys2goE", "2goE", "2goE", "2goE", "2goE", "goReverse",
			                "goReverse", "goReverse", "goReverse", "goReverse", "goReverse", "goReverse" } },
			{ "Law2_ScGeom_FrictPhys_CundallStrack", 0, 11,
			        { "pyHandleCustomCtorArgs", "getFunctorTypes", "get2DFunctorType1", "get2DFunctorType2", "2goE" } },
			{ "Law2_ScGeom_FrictPhys_CundallStrack", 80, 2,
			        { "checkOrder", "2goE", "2goE", "CundallStrack2goE", "2goE", "2goE", "2goE", "2goE", "goReverse",
			                "goReverse", "goReverse", "goReverse", "goReverse", "goReverse", "goReverse" } },
		};
	}

	std::string differenceInVirtualTables()
	{
		for (const Table& table : tables) {
			const py::object object = make(table.className);
			const void* start = &py::extract<yade::Serializable&>(object)();
			const std::string name = table.className;
			if (!fits(start, table.offset + sizeof(void*)) || offsetToTop(start, table.offset) != -std::ptrdiff_t(table.offset))
				return refusal(name + " has no table of virtual functions there", "byte " + std::to_string(table.offset));
			int slot = table.first;
			for (const char* function : table.functions) {
				const std::string found = functionInSlot(start, table.offset, slot);
				if (found.find(function) == std::string::npos)
					return refusal(name + " has " + found + " where " + function + " is expected",
					        "virtual function " + std::to_string(slot) + " at byte " + std::to_string(table.offset));
				++slot;
			}
		}
		return "";
	}

} // namespace proof
} // namespace contact_law
