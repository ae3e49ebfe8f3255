// Links grainray::grainray: fills a scene, runs it, writes a checkpoint and a picture.
#include <cmath>
#include <cstdio>

#include <grainray/render.hpp>
#include <grainray/simulation.hpp>

namespace {

// One grain, a tenth of a second of free fall.
grainray::Scene falling_grain() {
    grainray::Scene scene;
    scene.dt = 1e-3;
    scene.duration = 0.1;
    scene.materials.push_back({"grain"});
    scene.particles.push_back({"grains", "grain", grainray::ParticleList{{{0, 0, 10}}, {0.1}, {}, {}}, {}, {}, {}});
    return scene;
}

}  // namespace

int main() {
    const grainray::Scene scene = falling_grain();
    grainray::Simulation simulation(scene, grainray::place_particles(scene));
    simulation.run(scene.steps());

    const grainray::Frame frame = simulation.frame();
    const double fallen = 10 - frame.position.at(0).z;
    std::printf("fallen %.4f m in %.1f s\n", fallen, simulation.time());
    if (std::abs(fallen - 0.05) > 1e-3) return 1;

    grainray::write_checkpoint("grain.h5", simulation.checkpoint());
    grainray::write_png("grain.png", grainray::render(frame, scene, scene.render));
    return 0;
}
