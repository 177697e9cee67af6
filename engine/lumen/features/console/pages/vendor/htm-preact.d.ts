// The types of htm-preact.js, for authors of pages; they are not installed.
export { Component, createContext, h, render } from "preact";
export * from "preact/hooks";
import type { VNode } from "preact";

/** An element from a template; the values within it are not checked. */
export declare const html: (strings: TemplateStringsArray, ...values: any[]) => VNode<any>;
