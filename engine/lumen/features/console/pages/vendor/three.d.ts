// The types of three.js, for authors of pages; they are not installed.
export * from "three";
