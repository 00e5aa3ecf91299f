// SPDX-License-Identifier: MIT
// A camera that moves while the shutter is open; other scenes have no such block.

layout(std140, binding = kShutterBinding) uniform ShutterBlock { Shutter shutter; };

/// The motion of the camera from its pose in Frame, as two turns one after the other, to its position.
struct CameraPose {
  RigidMotion first;  // motion up to the middle of the segment
  RigidMotion then;   // motion from the middle on
  vec3 position;
};

/// The camera at a time of the path, 0..1.
CameraPose cameraAt(float time) {
  Moment m = momentAt(time, shutter.count.x);
  CameraSegment s = shutter.camera[m.segment];
  CameraPose pose;
  pose.first = motionOver(s.turn, vec3(0.0), 1.0);
  pose.then = motionOver(s.turnOver, s.slide.xyz, m.part - 0.5);
  pose.position = s.position.xyz + pose.then.shift;
  return pose;
}

/// A direction of the camera's pose in Frame, turned with it.
vec3 turnedWith(CameraPose pose, vec3 v) { return turnedBy(pose.then, turnedBy(pose.first, v)); }

/// A ray of the camera's pose in Frame, carried with it.
CameraRay carried(CameraPose pose, CameraRay ray) {
  CameraRay r;
  r.origin = pose.position + turnedWith(pose, ray.origin - frame.cameraPosition);
  r.direction = normalize(turnedWith(pose, ray.direction));
  return r;
}
