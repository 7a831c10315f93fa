// The way the camera went, packed: an hour at 20 poses a second takes 3 MiB. Pure.

import { create } from '@bufbuild/protobuf';
import { PoseValueSchema, type PoseValue, type TrackingState, type TrajectoryPoint } from './gen/flogmap/v1/map_pb';

const POSE = 7; // x, y, z, qx, qy, qz, qw
const LOST_FLAG = 128; // no pose
const MAPPED_FLAG = 64; // a view of it went into the map

export interface TimedPose {
  readonly timeNs: bigint;
  readonly pose?: PoseValue | undefined;
}

/** What an array of points and a path have in common. */
export interface PathPoints<Point extends TimedPose = TimedPose> {
  readonly length: number;
  at(index: number): Point | undefined;
}

export interface PathPoint extends TimedPose {
  readonly state: TrackingState;
  readonly mapped: boolean;
}

export class Path implements PathPoints<PathPoint> {
  private count = 0;
  private times = new BigInt64Array(0);
  private poses = new Float32Array(0);
  private about = new Uint8Array(0);

  get length(): number {
    return this.count;
  }

  /** Memory held. */
  get bytes(): number {
    return this.times.byteLength + this.poses.byteLength + this.about.byteLength;
  }

  /** From the end if negative, as with arrays. */
  at(index: number): PathPoint | undefined {
    const i = index < 0 ? this.count + index : index;
    if (i < 0 || i >= this.count) return undefined;
    const [x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 1] = this.poses.subarray(POSE * i, POSE * i + POSE);
    const pose = this.hasPose(i) ? create(PoseValueSchema, { x, y, z, qx, qy, qz, qw }) : undefined;
    return { timeNs: this.times[i] ?? 0n, pose, state: this.state(i), mapped: this.mapped(i) };
  }

  hasPose(i: number): boolean {
    return ((this.about[i] ?? LOST_FLAG) & LOST_FLAG) === 0;
  }

  mapped(i: number): boolean {
    return ((this.about[i] ?? 0) & MAPPED_FLAG) !== 0;
  }

  state(i: number): TrackingState {
    return ((this.about[i] ?? 0) & (MAPPED_FLAG - 1)) as TrackingState;
  }

  /** Coordinate 0, 1 or 2 of the place, metres. */
  place(i: number, axis: 0 | 1 | 2): number {
    return this.poses[POSE * i + axis] ?? 0;
  }

  /** Since the first point. */
  seconds(i: number): number {
    return Number((this.times[i] ?? 0n) - (this.times[0] ?? 0n)) / 1e9;
  }

  /** The first point of the newest `minutes`; 0 minutes stand for the whole path. */
  firstOfLast(minutes: number): number {
    if (minutes === 0) return 0;
    const since = this.seconds(this.count - 1) - 60 * minutes;
    let [first, end] = [0, this.count];
    while (first < end) {
      const middle = (first + end) >> 1;
      if (this.seconds(middle) < since) first = middle + 1;
      else end = middle;
    }
    return first;
  }

  /** Puts points at `first` and after it; what was there is overwritten, what came after it is dropped. */
  put(first: number, points: readonly TrajectoryPoint[]): void {
    this.count = first;
    this.makeRoom(first + points.length);
    for (const point of points) this.push(point);
  }

  private push({ timeNs, pose, state, mapped }: TrajectoryPoint): void {
    const i = this.count++;
    this.times[i] = timeNs;
    this.about[i] = state | (mapped ? MAPPED_FLAG : 0) | (pose ? 0 : LOST_FLAG);
    if (pose) this.poses.set([pose.x, pose.y, pose.z, pose.qx, pose.qy, pose.qz, pose.qw], POSE * i);
  }

  private makeRoom(wanted: number): void {
    if (wanted <= this.times.length) return;
    const room = Math.max(256, Math.ceil(wanted * 1.5));
    const [times, poses, about] = [new BigInt64Array(room), new Float32Array(POSE * room), new Uint8Array(room)];
    times.set(this.times.subarray(0, this.count));
    poses.set(this.poses.subarray(0, POSE * this.count));
    about.set(this.about.subarray(0, this.count));
    Object.assign(this, { times, poses, about });
  }
}
