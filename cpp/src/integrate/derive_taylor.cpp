// Writes the Taylor kernels: for each recipe the arm's motion is recorded, turned into a system of sums and products of
// series (docs/model.md, 5.5), and printed as C++, for packs of runs and for doubles. Run by the build: derive_taylor FILE.

#include <fstream>

#include "integrate/taylor_printer_by_four.hpp"

namespace arm3r {

static void derive(std::ostream& out) {
    std::size_t numbers = 0;
    Plant<Expr> plant;
    plant.arm.is_elbow = plant.controller.model.is_elbow = true;  // it has the most
    each_number([&](Expr&) { ++numbers; }, plant);
    out << "// Made by derive_taylor from the recorded motion of the arm.\n\n"
        << "template <class T>\nstruct Numbers {\n    std::array<const T*, " << numbers << "> at;\n"
        << "    ARM3R_INLINE explicit Numbers(const Plant<T>& plant) {\n        int i = 0;\n"
        << "        each_number([&](const T& x) ARM3R_INLINE_LAMBDA { at[i++] = &x; }, plant);\n    }\n};\n\n"
        << "template <std::size_t recipe, class T>\nstruct Recurrence;\n";
    for (std::size_t i = 0; i < recipes.size(); ++i) {
        const Recording recording(recipes[i]);
        const System system(recording.tape(), recipes[i]);
        Printer(system, out).print(i);
        if (!recipes[i].elbow) PrinterByFour(system, out).print(i);
    }
}

}  // namespace arm3r

int main(int count, char** arguments) {
    std::ofstream file(count == 2 ? arguments[1] : "");
    arm3r::derive(file);
    return file.flush() ? 0 : 1;
}
