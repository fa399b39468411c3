#pragma once

#include "app/bench.hpp"
#include "app/run.hpp"

#include <memory>

/// What of the engine is measured.
namespace catoptric::app {

/// "session/SCENE": a session of the scene, laid out and uploaded, without a frame. The engine must
/// outlive the subject.
Subject session_subject(Engine& engine, const scene::Scene& scene);
/// "hierarchy/SCENE": the tree for tracing over all its triangles at rest; counter "triangles".
Subject hierarchy_subject(const scene::Scene& scene);
/// "frame/SCENE/WxH/TECHNIQUE": a frame of the request's one technique, from its description until
/// it is done; counters "gpu_ms", and of a tracer "rays". Beside it "host/..." of the same, what
/// the calling thread does for it: update, compile, record, submit; counter "record_ms" of the
/// frame. `session`: of the request's scene. In all `iterations` of them are measured.
Subject frame_subject(std::shared_ptr<Session> session, Request request, int iterations);

} // namespace catoptric::app
