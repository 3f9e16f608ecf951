// SPDX-License-Identifier: BSD-3-Clause
// The chart in 3-D: camera, seabed and contours. These are drawn again only when the camera or the seabed changed; whatever moves is
// drawn by overlay.ts above them. So a computer without a graphics processor keeps up as well. Drawing space as in seabed.ts.
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { MapControls } from "three/examples/jsm/controls/MapControls.js";
import type { TerrainTile } from "../protocol";
import { type Contours, type DepthRange, contourLines, depthRange, exaggeration, seabedGeometry, seabedPicture } from "./seabed";

/** Camera and its target. */
export interface View3d {
  position: Vector3;
  target: Vector3;
  near: number;
  far: number;
  extent_m: number;
}

export interface Place {
  x: number;
  y: number;
  behind: boolean;
}

/** A place after projection, before the division by w; it is in front of the camera where w > near. */
export interface Clipped {
  x: number;
  y: number;
  w: number;
}

export class ChartScene {
  readonly camera = new PerspectiveCamera(32, 1, 1, 1e7);
  readonly controls: MapControls;
  contours: Contours | null = null;
  stretch = 1;
  extent_m = 2000;
  /** Of the seabed that is drawn; 0 without one. */
  posts = 0;
  /** True while the renderer is a program on the processor. */
  readonly software: boolean;
  private renderer: WebGLRenderer;
  private scene = new Scene();
  private seabed: Mesh<BufferGeometry, MeshBasicMaterial> | null = null;
  private lines: LineSegments<BufferGeometry, LineBasicMaterial> | null = null;
  private range: DepthRange | null = null;
  private width = 1;
  private height = 1;
  private viewProjection = new Matrix4();
  private where = new Vector3();
  private changed = true;

  constructor(canvas: HTMLCanvasElement) {
    this.software = rendersInSoftware();
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.software, alpha: true, powerPreference: "high-performance" });
    this.renderer.setClearColor(0, 0);
    this.controls = new MapControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.maxPolarAngle = 1.45;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => {
      this.changed = true;
    });
  }

  dispose() {
    this.controls.dispose();
    this.renderer.dispose();
    this.scene.traverse((thing) => {
      if (thing instanceof Mesh || thing instanceof LineSegments) thing.geometry.dispose();
    });
  }

  resize(width: number, height: number, pixelRatio: number) {
    this.width = width;
    this.height = height;
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.changed = true;
  }

  setSeabed(tile: TerrainTile | null, dark: boolean) {
    this.changed = true;
    if (this.seabed) {
      this.scene.remove(this.seabed);
      this.seabed.geometry.dispose();
      this.seabed.material.map?.dispose();
      this.seabed = null;
    }
    if (this.lines) {
      this.scene.remove(this.lines);
      this.lines.geometry.dispose();
      this.lines = null;
    }
    this.contours = null;
    this.range = tile && depthRange(tile);
    this.posts = tile && this.range ? tile.depth_m.length : 0;
    if (!tile || !this.range) return;
    this.extent_m = Math.max(tile.rows - 1, tile.columns - 1) * tile.spacing_m;
    this.stretch = exaggeration(this.extent_m, this.range.high);
    const material = new MeshBasicMaterial({
      map: seabedPicture(tile, this.range, this.stretch, dark),
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 2,
      polygonOffsetUnits: 4,
    });
    if (material.map && !this.software) material.map.anisotropy = 8;
    this.seabed = new Mesh(seabedGeometry(tile, this.stretch), material);
    this.scene.add(this.seabed);
    this.contours = contourLines(tile, this.range);
    const { segments } = this.contours;
    const vertices = new Float32Array(segments.length);
    for (let i = 0; i < segments.length; i += 3) {
      vertices[i] = segments[i + 1];
      vertices[i + 1] = -segments[i + 2] * this.stretch + this.extent_m * 2e-4;
      vertices[i + 2] = -segments[i];
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(vertices, 3));
    this.lines = new LineSegments(
      geometry,
      new LineBasicMaterial({ color: dark ? 0xbfe0da : 0x10282f, transparent: true, opacity: dark ? 0.3 : 0.32 }),
    );
    this.scene.add(this.lines);
  }

  /** Shows a square of this half width around a place, from the south and above. */
  look(north_m: number, east_m: number, half_m: number, polar = 0.72, azimuth = 0) {
    const fov = (this.camera.fov * Math.PI) / 360;
    const narrow = Math.min(1.25, this.camera.aspect);
    const away = (1.06 * half_m) / Math.tan(fov) / narrow;
    const seabed = this.range ? -0.5 * (this.range.low + this.range.high) * this.stretch : 0;
    this.controls.target.set(east_m, seabed, -north_m + 0.13 * half_m);
    const flat = away * Math.sin(polar);
    this.camera.position.set(
      east_m + flat * Math.sin(azimuth),
      seabed + away * Math.cos(polar),
      this.controls.target.z + flat * Math.cos(azimuth),
    );
    this.controls.minDistance = half_m / 40;
    this.controls.maxDistance = 8 * away;
    this.camera.near = away / 200;
    this.camera.far = away * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.changed = true;
  }
  view(): View3d {
    const { near, far, position } = this.camera;
    return { position: position.clone(), target: this.controls.target.clone(), near, far, extent_m: this.extent_m };
  }
  restore({ position, target, near, far, extent_m }: View3d) {
    this.camera.position.copy(position);
    this.controls.target.copy(target);
    Object.assign(this.camera, { near, far });
    this.extent_m = extent_m;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.changed = true;
  }
  zoom(factor: number) {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }
  turnTo(polar: number, azimuth: number) {
    const away = this.controls.getDistance();
    const { target } = this.controls;
    this.camera.position.set(
      target.x + away * Math.sin(polar) * Math.sin(azimuth),
      target.y + away * Math.cos(polar),
      target.z + away * Math.sin(polar) * Math.cos(azimuth),
    );
    this.controls.update();
  }

  /** Metres a pixel at a place. */
  metresAPixel(x: number, y: number, z: number): number {
    this.where.set(x, y, z);
    const away = this.where.distanceTo(this.camera.position);
    return (2 * away * Math.tan((this.camera.fov * Math.PI) / 360)) / this.height;
  }

  clip(north_m: number, east_m: number, down_m: number): Clipped {
    const e = this.viewProjection.elements;
    const [x, y, z] = [east_m, -down_m * this.stretch, -north_m];
    return {
      x: e[0] * x + e[4] * y + e[8] * z + e[12],
      y: e[1] * x + e[5] * y + e[9] * z + e[13],
      w: e[3] * x + e[7] * y + e[11] * z + e[15],
    };
  }
  onScreen({ x, y, w }: Clipped): Place {
    return { x: ((x / w) * 0.5 + 0.5) * this.width, y: (-(y / w) * 0.5 + 0.5) * this.height, behind: w <= this.camera.near };
  }
  project(north_m: number, east_m: number, down_m: number): Place {
    return this.onScreen(this.clip(north_m, east_m, down_m));
  }

  /** Where the line of sight through a pixel meets the seabed, or the depth given where no seabed is; null above the horizon. */
  seabedUnder(
    px: number,
    py: number,
    depthAt: (north: number, east: number) => number,
    otherwise_m: number,
  ): { north_m: number; east_m: number; depth_m: number } | null {
    const near = new Vector3((px / this.width) * 2 - 1, 1 - (py / this.height) * 2, -1).unproject(this.camera);
    const ray = new Vector3((px / this.width) * 2 - 1, 1 - (py / this.height) * 2, 1)
      .unproject(this.camera)
      .sub(near)
      .normalize();
    if (ray.y > -1e-3) return null;
    const top = near.y / -ray.y;
    const bottom = this.range ? (near.y + this.range.high * this.stretch) / -ray.y : top;
    for (let i = 0; i <= 200; ++i) {
      const along = top + ((bottom - top) * i) / 200;
      const at = near.clone().addScaledVector(ray, along);
      const depth = depthAt(-at.z, at.x);
      if (-at.y / this.stretch >= depth) return { north_m: -at.z, east_m: at.x, depth_m: depth };
    }
    const at = near.clone().addScaledVector(ray, (near.y + otherwise_m * this.stretch) / -ray.y);
    return { north_m: -at.z, east_m: at.x, depth_m: NaN };
  }

  render() {
    if (!this.changed) return;
    this.changed = false;
    this.camera.updateMatrixWorld();
    this.viewProjection.multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
    this.renderer.render(this.scene, this.camera);
  }
}

function rendersInSoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  const more = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = more ? String(gl?.getParameter(more.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}
