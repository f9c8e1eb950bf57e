#include "render/renderer.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "render/body_layers.h"
#include "render/gl_context.h"
#include "render/layers.h"
#include "render/picture_frame.h"

namespace smokebox {

struct Renderer::Impl {
  GlContext context;  // first: everything below lives in it
  int width, height;
  GlTarget target;
  Palette palette;
  SmokeLayer smoke;
  FieldLayer field;
  SolidsLayer solids;
  ArrowsLayer arrows;
  ColorBarLayer colorBars;
  TextLayer text;
  ProbesLayer probes;
  BodiesLayer bodies;
  ParticlesLayer particles;
  SpringsLayer springs;
  JointsLayer joints;
  ClothLayer cloth;
  TrailsLayer trails;
  CollisionsLayer collisions;

  Impl(int w, int h, GlBackend backend)
      : context(backend),
        width(w),
        height(h),
        target(context.gl(), w, h),
        palette(context.gl(), w, h),
        smoke(context.gl(), target),
        field(context.gl(), target),
        solids(palette),
        arrows(context.gl()),
        colorBars(palette),
        text(palette),
        probes(palette),
        bodies(palette),
        particles(palette),
        springs(palette),
        joints(palette),
        cloth(palette),
        trails(palette),
        collisions(palette) {}

  void drawDomain(const Snapshot& snapshot, const PictureFrame& frame);
  void drawInDomain(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame,
                    bool onGround);
  void drawAround(const Snapshot& snapshot, const PictureFrame& frame);
  void drawOnTop(const Snapshot& snapshot, const PictureFrame& frame);
};

namespace {
bool isField(LayerKind kind) {
  return kind == LayerKind::pressure || kind == LayerKind::vorticity || kind == LayerKind::speed ||
         kind == LayerKind::temperature;
}
/// Can it be drawn together with the ground?
bool fillsPicture(const Snapshot& snapshot, const LayerSpec& layer) {
  if (layer.kind == LayerKind::smoke) return !snapshot.smoke.empty();
  return isField(layer.kind) && layer.opacity >= 1 && hasField(snapshot, layer.kind);
}
}  // namespace

Renderer::Renderer(int width, int height, GlBackend backend) {
  checkInvariant(width > 0 && height > 0, "a picture has a size");
  impl_ = std::make_unique<Impl>(width, height, backend);
}

Renderer::~Renderer() {
  // Objects of OpenGL must be deleted in their own context.
  if (impl_) impl_->context.makeCurrent();
}

void Renderer::draw(const Snapshot& snapshot, Image& image) {
  Impl& r = *impl_;
  r.context.makeCurrent();
  const Gl& gl = r.context.gl();
  r.target.bind();
  gl.Enable(GL_FRAMEBUFFER_SRGB);
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours are premultiplied

  const PictureFrame frame = frameOf(snapshot, r.width, r.height);
  r.drawDomain(snapshot, frame);
  r.drawAround(snapshot, frame);
  r.drawOnTop(snapshot, frame);

  image.width = r.width;
  image.height = r.height;
  image.rgba.resize(std::size_t{4} * r.width * r.height);
  r.target.read(image.rgba.data());
  const GLenum error = gl.GetError();
  if (error != GL_NO_ERROR) throw GlError("drawing failed, OpenGL's error " + std::to_string(error));
}

/// In the order of the list, but that nothing which fills the fluid is painted over a solid or a body: inside
/// of one there is none, and its values there are only continued for the sake of smooth edges.
void Renderer::Impl::drawDomain(const Snapshot& snapshot, const PictureFrame& frame) {
  const std::vector<LayerSpec>& layers = snapshot.view.layers;
  const auto fillsFluid = [](const LayerSpec& l) { return l.kind == LayerKind::smoke || isField(l.kind); };
  const auto lastFluid = std::find_if(layers.rbegin(), layers.rend(), fillsFluid).base();  // one past it
  std::vector<const LayerSpec*> order, late;
  for (auto layer = layers.begin(); layer != layers.end(); ++layer) {
    if (layer == lastFluid) order.insert(order.end(), late.begin(), late.end());
    const bool partsFluid = layer->kind == LayerKind::solids || layer->kind == LayerKind::bodies;
    (partsFluid && layer < lastFluid ? late : order).push_back(&*layer);
  }
  if (lastFluid == layers.end()) order.insert(order.end(), late.begin(), late.end());
  const bool filled = !order.empty() && fillsPicture(snapshot, *order.front());
  if (!filled) {
    const LinearColor ground = linear(snapshot.view.background);
    context.gl().ClearColor(ground[0], ground[1], ground[2], 1);
    context.gl().Clear(GL_COLOR_BUFFER_BIT);
  }
  for (const LayerSpec* layer : order)
    drawInDomain(snapshot, *layer, frame, filled && layer == order.front());
}

void Renderer::Impl::drawInDomain(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame,
                                  bool onGround) {
  switch (layer.kind) {
    case LayerKind::smoke:
      if (!snapshot.smoke.empty()) smoke.draw(snapshot, layer, frame, onGround);
      break;
    case LayerKind::solids:
      solids.draw(snapshot, layer, frame);
      break;
    case LayerKind::pressure:
    case LayerKind::vorticity:
    case LayerKind::speed:
    case LayerKind::temperature:
      if (hasField(snapshot, layer.kind)) field.draw(snapshot, layer, frame, onGround);
      break;
    case LayerKind::velocity:
      arrows.draw(snapshot, layer, frame);
      break;
    case LayerKind::probes:
      probes.draw(snapshot, layer, frame);
      break;
    case LayerKind::bodies:
      bodies.draw(snapshot, layer, frame);
      break;
    case LayerKind::particles:
      particles.draw(snapshot, layer, frame);
      break;
    case LayerKind::springs:
      springs.draw(snapshot, layer, frame);
      break;
    case LayerKind::joints:
      joints.draw(snapshot, layer, frame);
      break;
    case LayerKind::cloth:
      cloth.draw(snapshot, layer, frame);
      break;
    case LayerKind::trails:
      trails.draw(snapshot, layer, frame);
      break;
    case LayerKind::collisions:
      collisions.draw(snapshot, layer, frame);
      break;
    case LayerKind::caption:
    case LayerKind::time:
      break;  // on top of everything
  }
}

/// What the picture shows beyond the domain: a ground of its own, and a thin frame.
void Renderer::Impl::drawAround(const Snapshot& snapshot, const PictureFrame& frame) {
  constexpr double kSlack = 0.51;  // less than this beyond the domain is rounding, not a margin
  const bool sides = frame.left > kSlack || frame.right < width - kSlack;
  const bool ends = frame.top > kSlack || frame.bottom < height - kSlack;
  if (!sides && !ends) return;
  const Color& ground = snapshot.view.background;
  const Color black{0, 0, 0}, white{1, 1, 1};
  const LinearColor beyond = linear(mixed(ground, black, frame.darkGround ? 0.45 : 0.09));
  const LinearColor line = linear(mixed(ground, frame.darkGround ? white : black, 0.30));
  const double far = 8;  // pixels beyond the picture, so that no antialiased edge lies in it
  if (frame.left > kSlack) palette.panels.add(-far, -far, frame.left, height + far, beyond);
  if (frame.right < width - kSlack) palette.panels.add(frame.right, -far, width + far, height + far, beyond);
  if (frame.top > kSlack) palette.panels.add(frame.left, -far, frame.right, frame.top, beyond);
  if (frame.bottom < height - kSlack)
    palette.panels.add(frame.left, frame.bottom, frame.right, height + far, beyond);
  const double thin = frame.line(1.2);
  const double left = frame.left - thin, right = frame.right + thin, top = frame.top - thin,
               bottom = frame.bottom + thin;
  palette.panels.add(left, top, frame.left, bottom, line);
  palette.panels.add(frame.right, top, right, bottom, line);
  palette.panels.add(frame.left, top, frame.right, frame.top, line);
  palette.panels.add(frame.left, frame.bottom, frame.right, bottom, line);
  palette.panels.flush();
}

void Renderer::Impl::drawOnTop(const Snapshot& snapshot, const PictureFrame& frame) {
  std::vector<const LayerSpec*> bars;
  for (const LayerSpec& layer : snapshot.view.layers)
    if (isField(layer.kind) && layer.bar && hasField(snapshot, layer.kind)) bars.push_back(&layer);
  colorBars.draw(snapshot, bars, frame);
  for (const LayerSpec& layer : snapshot.view.layers) {
    if (layer.kind == LayerKind::time) text.drawTime(snapshot, layer, frame);
    if (layer.kind == LayerKind::caption) text.drawCaptions(snapshot, layer, frame);
  }
}

}  // namespace smokebox
