// List of all studies (`patina study`), and the function of each.
#pragma once

#include "app/studies/framework/study.h"

namespace patina {

// All studies, in the order of `patina study all`.
const std::vector<Study>& studies();
// Runs the study and names its tables.
std::vector<WorkPrecisionTable> tablesOf(const Study& study, const StudyOptions& options,
                                         Progress& progress);

// Samplers of the field on shapes with a known distance.
// Tables: value [m] and direction [deg] for sphere, torus and box by sampler and resolution; a
// sphere as a mesh. "order" is the fitted order of the row's sampler.
std::vector<WorkPrecisionTable> fieldStudy(const StudyOptions& options, Progress& progress);

// Contact step, proxy and ray, on the fixed test (contact_test_path.h): force against its closed
// form, and nanoseconds per tick, by surface, sampler, tip and friction; cracks; scale; order of
// the contact point (T-K06b). Finally shapes with several normals.
std::vector<WorkPrecisionTable> contactStudy(const StudyOptions& options, Progress& progress);

// Friction in time: dissipation of a stroke back and forth, stick-slip, and direction of friction,
// against closed forms (MATH 2.6), by period and speed.
// Energy of a cycle (T-K09b), period of stick-slip (T-K09e), direction on a circle by the paper's
// slip and by displacement. ns is per tick with friction; for stick-slip, device included.
std::vector<WorkPrecisionTable> frictionStudy(const StudyOptions& options, Progress& progress);

// Offset, magnetic and merged surfaces (K12-K14): force and depth against closed forms, work
// over closed loops (T-ENER), and nanoseconds per tick.
std::vector<WorkPrecisionTable> surfacesStudy(const StudyOptions& options, Progress& progress);

// Painting (K15-K18) and relief (K21, F8): coverage and weight, height and slope against
// closed forms, and their run time.
std::vector<WorkPrecisionTable> paintStudy(const StudyOptions& options, Progress& progress);

// Painted material (K22, K23): value by the grid, work over closed loops (F6), nanoseconds.
std::vector<WorkPrecisionTable> materialStudy(const StudyOptions& options, Progress& progress);

// Closed loop against theory: stability limit, restitution and stabilisers.
// Limit against eigenvalues (MATH 2.1.2, 2.1.3), restitution against the damped half wave (F4),
// encoder resolution against dry friction (F5), and the table of stabilisers (MATH 2.3); then
// curved and creased surfaces. ns is per tick of the loop, device included.
std::vector<WorkPrecisionTable> stabilityStudy(const StudyOptions& options, Progress& progress);

// A device on the wire: resolution, timing and max stiffness.
// The emulated Falcon with its real driver: one count and one motor value over the workspace; round
// trips and ages in real time, with and without wire faults (ns: of a round trip); the wall
// stiffness at which oscillation begins against eigenvalues, also with backlash and dry friction;
// and the displayed stiffness up to 1e5 N/m with virtual coupling.
std::vector<WorkPrecisionTable> deviceStudy(const StudyOptions& options, Progress& progress);

// Error of a marker rig's pose against time per frame (A04), over distance, blur, noise and
// camera, of a tip found by pivoting (A05), and of rigs made by hand after their calibration (A31).
// ns is per frame; for the tip and for rigs, per fit.
std::vector<WorkPrecisionTable> trackingStudy(const StudyOptions& options, Progress& progress);

// Error of filtered paths against run time (A06, A07): camera alone and fused with the probe,
// clean and with faults; height from acceleration by speed; stiffness from noisy presses.
// ns is per second of scan; for stiffness, per estimate.
std::vector<WorkPrecisionTable> filterStudy(const StudyOptions& options, Progress& progress);

// Accuracy and run time of registration methods (A10) over initial pose, noise and outliers;
// convergence; number of points. The truth is the pose before each path was moved.
// ns is per registration; for convergence, per that number of iterations.
std::vector<WorkPrecisionTable> registrationStudy(const StudyOptions& options, Progress& progress);

// Fourier textures: truncation error by number of harmonics and error of blended ends (A18,
// A19); run time and rounding of each evaluation form (A20, A21).
// ns is per fit; for forms, per height and gradient. Errors are fractions of the rms height.
std::vector<WorkPrecisionTable> textureStudy(const StudyOptions& options, Progress& progress);

// Error of a felt force against the time of scanning: frames of a rig made by hand, as printed and
// calibrated, through poses, path and registration to a texture.
// ns is per scan, from its frames to the texture.
std::vector<WorkPrecisionTable> scanStudy(const StudyOptions& options, Progress& progress);

} // namespace patina
