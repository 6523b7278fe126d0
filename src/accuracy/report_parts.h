// Sections, style and script of the HTML report; private to this folder.
#pragma once

#include <string>

#include "accuracy/measurement.h"

namespace whit::accuracy {

extern const char* const kReportStyle;   // the content of <style>
extern const char* const kReportScript;  // the content of <script>

std::string sceneSection(const SceneSweep& sweep, std::size_t number);
std::string verdictList(const SceneSweep& sweep);
std::string pointTable(const SceneSweep& sweep);
std::string causeTable(const SceneSweep& sweep);
std::string stageTable(const SceneSweep& sweep);

// "data:image/png;base64,..."
std::string dataUri(const std::string& png);

}  // namespace whit::accuracy
