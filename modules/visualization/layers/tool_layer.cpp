#include "visualization/layers/tool_layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <vtkCamera.h>
#include <vtkConeSource.h>
#include <vtkCylinderSource.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkSphereSource.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include "visualization/values/palette.h"

namespace patina {
namespace {

constexpr double kEdge = 6;      // margin of arrow and number to the picture's edge [pixels]
constexpr double kBeside = 12;   // distance of the number from the arrow's end [pixels of 72 dpi]
constexpr double kUpright = 0.2; // sine below which a force counts as upright in the picture
constexpr double kSmallestForce = 0.005; // smallest drawn force [N]
constexpr double kArrowPerNewton = 0.16; // fraction of the picture's height
constexpr double kLongestArrow = 0.32;   // same; larger forces show in the number only
constexpr double kPointRadius = 0.013;   // same

vtkSmartPointer<vtkActor> actorOf(vtkAlgorithm* source, const palette::Color& color,
                                  double opacity) {
  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->SetColor(palette::forVtk(color));
  property->SetOpacity(opacity);
  property->SetAmbient(0.25);
  property->SetDiffuse(0.75);
  property->SetSpecular(0.25);
  property->SetSpecularPower(30);
  return actor;
}

vtkSmartPointer<vtkActor> unitBall(const palette::Color& color, double opacity) {
  const vtkNew<vtkSphereSource> source;
  source->SetRadius(1);
  source->SetThetaResolution(28);
  source->SetPhiResolution(20);
  return actorOf(source, color, opacity);
}

// Rod along +y from 0 to 1, radius 1 at the bottom and `top` at the end.
vtkSmartPointer<vtkActor> unitRod(const palette::Color& color) {
  const vtkNew<vtkCylinderSource> source;
  source->SetRadius(1);
  source->SetHeight(1);
  source->SetCenter(0, 0.5, 0);
  source->SetResolution(20);
  return actorOf(source, color, 1);
}

// Cone along +y with a base of radius 1 at 0 and its apex at 1.
vtkSmartPointer<vtkActor> unitCone(const palette::Color& color) {
  const vtkNew<vtkConeSource> source;
  source->SetRadius(1);
  source->SetHeight(1);
  source->SetDirection(0, 1, 0);
  source->SetCenter(0, 0.5, 0);
  source->SetResolution(24);
  return actorOf(source, color, 1);
}

// Maps +y to the segment from a to b, and the unit radius to `radius`.
void stretch(vtkActor& actor, const Vec3& a, const Vec3& b, double radius) {
  const Vec3 along = b - a;
  const double length = along.norm();
  if (length <= 0) return;
  const Vec3 y = along / length;
  const Vec3 x = y.unitOrthogonal();
  const Vec3 z = x.cross(y);
  const vtkNew<vtkMatrix4x4> matrix;
  for (int row = 0; row < 3; ++row) {
    matrix->SetElement(row, 0, radius * x[row]);
    matrix->SetElement(row, 1, along[row]);
    matrix->SetElement(row, 2, radius * z[row]);
    matrix->SetElement(row, 3, a[row]);
  }
  actor.SetUserMatrix(matrix);
}

void placeBall(vtkActor& actor, const Vec3& centre, double radius) {
  actor.SetScale(radius);
  actor.SetPosition(centre[0], centre[1], centre[2]);
}

} // namespace

Vec3 seenContact(const ToolSample& sample) {
  if (!sample.contact) return sample.surface;
  const double reach = sample.depth - (sample.surface - sample.tip).dot(sample.normal);
  return sample.vcp - reach * sample.normal;
}

ToolLayer::ToolLayer(vtkRenderer& front, vtkRenderer& overlay)
    : overlay_(overlay), ball_(unitBall(palette::kTool, 1)), neck_(unitCone(palette::kTool)),
      shaft_(unitRod(palette::kToolShaft)), ghost_(unitBall(palette::kGhost, 0.45)),
      spring_(unitRod(palette::kGhost)), stem_(unitRod(palette::kContactPoint)),
      contact_(unitBall(palette::kContactPoint, 1)), arrow_shaft_(unitRod(palette::kForce)),
      arrow_head_(unitCone(palette::kForce)), gap_(unitRod(palette::kGhost)),
      label_(vtkSmartPointer<vtkTextActor>::New()),
      gap_label_(vtkSmartPointer<vtkTextActor>::New()) {
  for (const auto& actor : {ball_, neck_, shaft_}) front.AddActor(actor);
  for (const auto& actor : {spring_, stem_, ghost_, contact_, arrow_shaft_, arrow_head_, gap_})
    overlay.AddActor(actor);
  for (const auto& label : {label_, gap_label_}) {
    label->GetTextProperty()->BoldOn();
    label->GetTextProperty()->SetVerticalJustificationToCentered();
    overlay.AddActor2D(label);
  }
  place();
}

void ToolLayer::setTipRadius(double radius) {
  tip_radius_ = radius;
  place();
}

void ToolLayer::update(const ToolSample& sample, const std::optional<Vec3>& nearest) {
  sample_ = sample;
  nearest_ = nearest;
  place();
}

void ToolLayer::faceCamera(vtkCamera& camera) {
  const Vec3 up(camera.GetViewUp());
  const Vec3 back = Vec3(camera.GetPosition()) - Vec3(camera.GetFocalPoint());
  right_ = up.cross(back).normalized();
  lean_ = (0.55 * right_ + 0.65 * back.cross(right_).normalized() + 0.5 * back.normalized())
              .normalized();
  length_ = 2 * back.norm() * std::tan(0.5 * camera.GetViewAngle() * M_PI / 180);
  place();
}

void ToolLayer::setVisible(bool on) {
  visible_ = on;
  place();
}

void ToolLayer::setTextStyle(const TextStyle& letters) {
  TextStyle larger = letters;
  larger.size += 3;
  write(*label_->GetTextProperty(), larger, palette::kForce, true);
  write(*gap_label_->GetTextProperty(), letters, palette::kGhost, true);
  shaft_->GetProperty()->SetColor(palette::forVtk(letters.ground.shaft));
}

std::optional<Vec3> ToolLayer::arrowEnd() const {
  const double newtons = sample_.force.norm();
  if (!visible_ || !(newtons > kSmallestForce)) return std::nullopt;
  const Vec3 held = sample_.contact ? sample_.vcp : sample_.tip;
  return held + sample_.force / newtons * (ballRadius() + arrowLength(newtons));
}

double ToolLayer::arrowLength(double newtons) const {
  return std::min(kArrowPerNewton * newtons, kLongestArrow) * length_;
}

std::optional<Vec2> ToolLayer::inPicture(const Vec3& p) const {
  auto* window = overlay_.GetRenderWindow();
  if (window == nullptr || window->GetSize()[0] <= 0) return std::nullopt;
  vtkCamera& camera = *overlay_.GetActiveCamera();
  if (!((p - Vec3(camera.GetPosition())).dot(Vec3(camera.GetDirectionOfProjection())) > 0))
    return std::nullopt; // behind the camera
  overlay_.SetWorldPoint(p[0], p[1], p[2], 1);
  overlay_.WorldToDisplay();
  const double* pixel = overlay_.GetDisplayPoint();
  return Vec2(pixel[0], pixel[1]);
}

bool ToolLayer::isOutside(const Vec3& p) const {
  const auto pixel = inPicture(p);
  if (!pixel) return false;
  const int* size = overlay_.GetRenderWindow()->GetSize();
  return pixel->minCoeff() < kEdge || pixel->x() > size[0] - kEdge || pixel->y() > size[1] - kEdge;
}

int ToolLayer::distanceBeside() const {
  const double dpi = overlay_.GetRenderWindow()->GetDPI();
  return static_cast<int>(std::lround(kBeside * std::max(1.0, dpi / 72)));
}

// Places the number beyond the arrow's end, inside the picture and off its corner.
void ToolLayer::placeNumber(const Vec3& end, const Vec3& direction, double newtons) {
  const auto at = inPicture(end);
  if (!at) return;
  char words[32];
  std::snprintf(words, sizeof words, " %.2f N ", newtons);
  label_->SetInput(words);
  const double across = direction.dot(right_); // an upright force keeps the side
  if (std::abs(across) > kUpright) leftwards_ = across < 0;
  vtkTextProperty* text = label_->GetTextProperty();
  text->SetJustification(leftwards_ ? VTK_TEXT_RIGHT : VTK_TEXT_LEFT);
  const int gap = distanceBeside();
  int beside = leftwards_ ? -gap : gap, over = 0;
  std::array<int, 4> box{};
  if (vtkTextRenderer::GetInstance()->GetBoundingBox(text, words, box.data(),
                                                     overlay_.GetRenderWindow()->GetDPI())) {
    const int* size = overlay_.GetRenderWindow()->GetSize();
    const double wide = box[1] - box[0], high = box[3] - box[2];
    const Vec2 natural = *at + Vec2(beside - (leftwards_ ? wide : 0), -0.5 * high);
    Vec2 low(std::clamp(natural.x(), kEdge, std::max(kEdge, size[0] - kEdge - wide)),
             std::clamp(natural.y(), kEdge, std::max(kEdge, size[1] - kEdge - high)));
    if (low.x() != natural.x()) { // the number would cover the arrow's head
      const auto behind = inPicture(end - 0.1 * length_ * direction);
      const double over_it = behind && behind->y() > at->y() ? -high - kEdge : kEdge;
      low.y() = std::clamp(at->y() + over_it, kEdge, std::max(kEdge, size[1] - kEdge - high));
    }
    if (low.x() < corner_ && low.y() < corner_) low.y() = corner_;
    beside += static_cast<int>(std::lround(low.x() - natural.x()));
    over = static_cast<int>(std::lround(low.y() - natural.y()));
  }
  label_->SetPosition(std::round(at->x()) + beside, std::round(at->y()) + over);
}

// The line begins at the ball, if the tip is one, so that its length is the way to contact.
void ToolLayer::placeGap() {
  const bool free = visible_ && nearest_ && !sample_.contact && !sample_.attracted;
  const Vec3 across = free ? Vec3(*nearest_ - sample_.tip) : Vec3::Zero();
  const double gap = across.norm() - tip_radius_;
  const bool shown = free && gap > 1e-3 * length_;
  gap_->SetVisibility(shown);
  const Vec3 begin = shown ? Vec3(*nearest_ - gap * across.normalized()) : Vec3::Zero();
  const auto middle = shown ? inPicture((begin + *nearest_) / 2) : std::nullopt;
  gap_label_->SetVisibility(middle.has_value());
  if (!shown) return;
  stretch(*gap_, begin, *nearest_, 0.0012 * length_);
  if (!middle) return;
  char words[32];
  std::snprintf(words, sizeof words, " %.*f mm ", gap < 1e-3 ? 2 : 1, 1e3 * gap);
  gap_label_->SetInput(words);
  gap_label_->SetPosition(std::round(middle->x()) + distanceBeside(), std::round(middle->y()));
}

double ToolLayer::ballRadius() const {
  return tip_radius_ > 0 ? tip_radius_ : kPointRadius * length_;
}

void ToolLayer::place() {
  const Vec3 held = sample_.contact ? sample_.vcp : sample_.tip;
  const double radius = ballRadius();
  const double shaft_radius = 0.006 * length_;
  placeBall(*ball_, held, radius);
  // The neck's base is on the shaft and its apex inside the ball.
  const Vec3 neck_end = held + lean_ * (0.8 * radius + 0.05 * length_);
  stretch(*neck_, neck_end, held, shaft_radius);
  stretch(*shaft_, neck_end, neck_end + lean_ * (0.32 * length_), shaft_radius);

  placeBall(*ghost_, sample_.tip, radius);
  const bool near = sample_.contact || sample_.attracted;
  const Vec3 seen = seenContact(sample_);
  placeBall(*contact_, seen, 0.004 * length_);
  // The stem would keep its own length of 1 m if its segment had length zero.
  const bool apart = (seen - held).norm() > 1e-4 * length_;
  if (apart) stretch(*stem_, held, seen, 0.0013 * length_);
  stretch(*spring_, sample_.tip, held, 0.0016 * length_);

  const double newtons = sample_.force.norm();
  const bool pushed = newtons > kSmallestForce;
  if (pushed) {
    const Vec3 direction = sample_.force / newtons;
    const double head = std::min(0.045, 0.5 * kArrowPerNewton * newtons) * length_;
    const Vec3 begin = held + direction * radius;
    double length = arrowLength(newtons);
    for (int i = 0; i < 8 && isOutside(begin + direction * length); ++i) length *= 0.8;
    const Vec3 end = begin + direction * length;
    stretch(*arrow_shaft_, begin, end - direction * head, 0.0055 * length_);
    stretch(*arrow_head_, end - direction * head, end, 0.35 * head);
    placeNumber(end, direction, newtons);
  }
  for (const auto& actor : {ball_, neck_, shaft_}) actor->SetVisibility(visible_);
  for (const auto& actor : {ghost_, spring_}) actor->SetVisibility(visible_ && sample_.contact);
  contact_->SetVisibility(visible_ && near);
  stem_->SetVisibility(visible_ && near && apart);
  for (const auto& actor : {arrow_shaft_, arrow_head_}) actor->SetVisibility(visible_ && pushed);
  placeGap();
  const auto number_at = pushed ? arrowEnd() : std::nullopt;
  label_->SetVisibility(number_at && inPicture(*number_at));
}

} // namespace patina
