// Where keys and dropped files count that are not for one control.

/** The whole window in the page; in another site's page the element alone. */
export function surroundings(part: Node): EventTarget {
  const root = part.getRootNode();
  return root instanceof ShadowRoot ? root.host : window;
}
