var js={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},Qs={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},km=0,kd=1,Bm=2;var yr=1,zm=2,go=3,ls=0,Un=1,Ai=2,_r=0,vo=1,Bd=2,zd=3,Vd=4,Vm=5;var br=100,Gm=101,Hm=102,Wm=103,Xm=104,qm=200,Ym=201,$m=202,Zm=203,Gd=204,Hd=205,Km=206,Jm=207,jm=208,Qm=209,eg=210,tg=211,ng=212,ig=213,sg=214,Wl=0,Xl=1,ql=2,oo=3,Yl=4,$l=5,Zl=6,Kl=7,bc=0,rg=1,og=2,cs=0,Wd=1,Xd=2,qd=3,Yd=4,$d=5,Zd=6,Kd=7;var Jd=300,Sr=301,xo=302,Sc=303,Mc=304,Jl=1e3,ts=1001,jl=1002,In=1003,ag=1004;var Ra=1005;var Kn=1006,wc=1007;var Ps=1008;var ni=1009,jd=1010,Qd=1011,yo=1012,Tc=1013,Bi=1014,Ci=1015,zi=1016,Ec=1017,Ac=1018,Mr=1020,ef=35902,tf=35899,nf=1021,sf=1022,Vi=1023,Es=1026,Ls=1027,Cc=1028,Rc=1029,er=1030,Pc=1031;var Lc=1033,Pa=33776,La=33777,Ia=33778,Na=33779,Ic=35840,Nc=35841,Dc=35842,Fc=35843,Oc=36196,Uc=37492,kc=37496,Bc=37488,zc=37489,Da=37490,Vc=37491,Gc=37808,Hc=37809,Wc=37810,Xc=37811,qc=37812,Yc=37813,$c=37814,Zc=37815,Kc=37816,Jc=37817,jc=37818,Qc=37819,eh=37820,th=37821,nh=36492,ih=36494,sh=36495,rh=36283,oh=36284,Fa=36285,ah=36286;var ra=2300,Ql=2301,Gl=2302,Ld=2303,Id=2400,Nd=2401,Dd=2402;var lg=3200;var Oa=0,cg=1,Is="",$n="srgb",mr="srgb-linear",oa="linear",It="srgb";var Hl=7680;var hg=519,ug=512,dg=513,fg=514,rf=515,pg=516,mg=517,of=518,af=519,gg=35044;var lf="300 es",Ti=2e3,ao=2001;function Ny(i){for(let e=i.length-1;e>=0;--e)if(i[e]>=65535)return!0;return!1}function Dy(i){return ArrayBuffer.isView(i)&&!(i instanceof DataView)}function aa(i){return document.createElementNS("http://www.w3.org/1999/xhtml",i)}function vg(){let i=aa("canvas");return i.style.display="block",i}var lm={},lo=null;function cf(...i){let e="THREE."+i.shift();lo?lo("log",e,...i):console.log(e,...i)}function xg(i){let e=i[0];if(typeof e=="string"&&e.startsWith("TSL:")){let t=i[1];t&&t.isStackTrace?i[0]+=" "+t.getLocation():i[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return i}function $e(...i){i=xg(i);let e="THREE."+i.shift();if(lo)lo("warn",e,...i);else{let t=i[0];t&&t.isStackTrace?console.warn(t.getError(e)):console.warn(e,...i)}}function nt(...i){i=xg(i);let e="THREE."+i.shift();if(lo)lo("error",e,...i);else{let t=i[0];t&&t.isStackTrace?console.error(t.getError(e)):console.error(e,...i)}}function ia(...i){let e=i.join(" ");e in lm||(lm[e]=!0,$e(...i))}function yg(i,e,t){return new Promise(function(n,s){function r(){switch(i.clientWaitSync(e,i.SYNC_FLUSH_COMMANDS_BIT,0)){case i.WAIT_FAILED:s();break;case i.TIMEOUT_EXPIRED:setTimeout(r,t);break;default:n()}}setTimeout(r,t)})}var _g={[Wl]:Wl,[ql]:Zl,[Yl]:Yl,[oo]:$l,[Xl]:Xl,[Zl]:ql,[Kl]:Kl,[$l]:oo},ki=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){let n=this._listeners;return n===void 0?!1:n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){let n=this._listeners;if(n===void 0)return;let s=n[e];if(s!==void 0){let r=s.indexOf(t);r!==-1&&s.splice(r,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let n=t[e.type];if(n!==void 0){e.target=this;let s=n.slice(0);for(let r=0,o=s.length;r<o;r++)s[r].call(this,e);e.target=null}}},zn=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],cm=1234567,so=Math.PI/180,co=180/Math.PI;function _o(){let i=Math.random()*4294967295|0,e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0;return(zn[i&255]+zn[i>>8&255]+zn[i>>16&255]+zn[i>>24&255]+"-"+zn[e&255]+zn[e>>8&255]+"-"+zn[e>>16&15|64]+zn[e>>24&255]+"-"+zn[t&63|128]+zn[t>>8&255]+"-"+zn[t>>16&255]+zn[t>>24&255]+zn[n&255]+zn[n>>8&255]+zn[n>>16&255]+zn[n>>24&255]).toLowerCase()}function gt(i,e,t){return Math.max(e,Math.min(t,i))}function hf(i,e){return(i%e+e)%e}function Fy(i,e,t,n,s){return n+(i-e)*(s-n)/(t-e)}function Oy(i,e,t){return i!==e?(t-i)/(e-i):0}function sa(i,e,t){return(1-t)*i+t*e}function Uy(i,e,t,n){return sa(i,e,1-Math.exp(-t*n))}function ky(i,e=1){return e-Math.abs(hf(i,e*2)-e)}function By(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*(3-2*i))}function zy(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*i*(i*(i*6-15)+10))}function Vy(i,e){return i+Math.floor(Math.random()*(e-i+1))}function Gy(i,e){return i+Math.random()*(e-i)}function Hy(i){return i*(.5-Math.random())}function Wy(i){i!==void 0&&(cm=i);let e=cm+=1831565813;return e=Math.imul(e^e>>>15,e|1),e^=e+Math.imul(e^e>>>7,e|61),((e^e>>>14)>>>0)/4294967296}function Xy(i){return i*so}function qy(i){return i*co}function Yy(i){return i>0&&Number.isInteger(i)&&2**Math.round(Math.log2(i))===i}function $y(i){return Math.pow(2,Math.ceil(Math.log(i)/Math.LN2))}function uf(i){return Math.pow(2,Math.floor(Math.log(i)/Math.LN2))}function Zy(i,e,t,n,s){let r=Math.cos,o=Math.sin,a=r(t/2),l=o(t/2),c=r((e+n)/2),h=o((e+n)/2),u=r((e-n)/2),d=o((e-n)/2),f=r((n-e)/2),m=o((n-e)/2);switch(s){case"XYX":i.set(a*h,l*u,l*d,a*c);break;case"YZY":i.set(l*d,a*h,l*u,a*c);break;case"ZXZ":i.set(l*u,l*d,a*h,a*c);break;case"XZX":i.set(a*h,l*m,l*f,a*c);break;case"YXY":i.set(l*f,a*h,l*m,a*c);break;case"ZYZ":i.set(l*m,l*f,a*h,a*c);break;default:$e("MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function df(i){switch(i.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function bg(i,e){if(e.constructor===Float32Array)return i;let t=df(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(i/t,-1)}function Sg(i,e){if(e.constructor===Float32Array)return i;let t=df(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(i*t)}var lh={DEG2RAD:so,RAD2DEG:co,generateUUID:_o,clamp:gt,euclideanModulo:hf,mapLinear:Fy,inverseLerp:Oy,lerp:sa,damp:Uy,pingpong:ky,smoothstep:By,smootherstep:zy,randInt:Vy,randFloat:Gy,randFloatSpread:Hy,seededRandom:Wy,degToRad:Xy,radToDeg:qy,isPowerOfTwo:Yy,ceilPowerOfTwo:$y,floorPowerOfTwo:uf,setQuaternionFromProperEuler:Zy,normalize:Sg,denormalize:bg},He=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw new Error("THREE.Vector2: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,n=this.y,s=e.elements;return this.x=s[0]*t+s[3]*n+s[6],this.y=s[1]*t+s[4]*n+s[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=gt(this.x,e.x,t.x),this.y=gt(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=gt(this.x,e,t),this.y=gt(this.y,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(gt(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(gt(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let n=Math.cos(t),s=Math.sin(t),r=this.x-e.x,o=this.y-e.y;return this.x=r*n-o*s+e.x,this.y=r*s+o*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},Dn=class{constructor(e=0,t=0,n=0,s=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=n,this._w=s}static slerpFlat(e,t,n,s,r,o,a){let l=n[s+0],c=n[s+1],h=n[s+2],u=n[s+3],d=r[o+0],f=r[o+1],m=r[o+2],_=r[o+3];if(u!==_||l!==d||c!==f||h!==m){let g=l*d+c*f+h*m+u*_;g<0&&(d=-d,f=-f,m=-m,_=-_,g=-g);let p=1-a;if(g<.9995){let y=Math.acos(g),A=Math.sin(y);p=Math.sin(p*y)/A,a=Math.sin(a*y)/A,l=l*p+d*a,c=c*p+f*a,h=h*p+m*a,u=u*p+_*a}else{l=l*p+d*a,c=c*p+f*a,h=h*p+m*a,u=u*p+_*a;let y=1/Math.sqrt(l*l+c*c+h*h+u*u);l*=y,c*=y,h*=y,u*=y}}e[t]=l,e[t+1]=c,e[t+2]=h,e[t+3]=u}static multiplyQuaternionsFlat(e,t,n,s,r,o){let a=n[s],l=n[s+1],c=n[s+2],h=n[s+3],u=r[o],d=r[o+1],f=r[o+2],m=r[o+3];return e[t]=a*m+h*u+l*f-c*d,e[t+1]=l*m+h*d+c*u-a*f,e[t+2]=c*m+h*f+a*d-l*u,e[t+3]=h*m-a*u-l*d-c*f,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,n,s){return this._x=e,this._y=t,this._z=n,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let n=e._x,s=e._y,r=e._z,o=e._order,a=Math.cos,l=Math.sin,c=a(n/2),h=a(s/2),u=a(r/2),d=l(n/2),f=l(s/2),m=l(r/2);switch(o){case"XYZ":this._x=d*h*u+c*f*m,this._y=c*f*u-d*h*m,this._z=c*h*m+d*f*u,this._w=c*h*u-d*f*m;break;case"YXZ":this._x=d*h*u+c*f*m,this._y=c*f*u-d*h*m,this._z=c*h*m-d*f*u,this._w=c*h*u+d*f*m;break;case"ZXY":this._x=d*h*u-c*f*m,this._y=c*f*u+d*h*m,this._z=c*h*m+d*f*u,this._w=c*h*u-d*f*m;break;case"ZYX":this._x=d*h*u-c*f*m,this._y=c*f*u+d*h*m,this._z=c*h*m-d*f*u,this._w=c*h*u+d*f*m;break;case"YZX":this._x=d*h*u+c*f*m,this._y=c*f*u+d*h*m,this._z=c*h*m-d*f*u,this._w=c*h*u-d*f*m;break;case"XZY":this._x=d*h*u-c*f*m,this._y=c*f*u-d*h*m,this._z=c*h*m+d*f*u,this._w=c*h*u+d*f*m;break;default:$e("Quaternion: .setFromEuler() encountered an unknown order: "+o)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let n=t/2,s=Math.sin(n);return this._x=e.x*s,this._y=e.y*s,this._z=e.z*s,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,n=t[0],s=t[4],r=t[8],o=t[1],a=t[5],l=t[9],c=t[2],h=t[6],u=t[10],d=n+a+u;if(d>0){let f=.5/Math.sqrt(d+1);this._w=.25/f,this._x=(h-l)*f,this._y=(r-c)*f,this._z=(o-s)*f}else if(n>a&&n>u){let f=2*Math.sqrt(1+n-a-u);this._w=(h-l)/f,this._x=.25*f,this._y=(s+o)/f,this._z=(r+c)/f}else if(a>u){let f=2*Math.sqrt(1+a-n-u);this._w=(r-c)/f,this._x=(s+o)/f,this._y=.25*f,this._z=(l+h)/f}else{let f=2*Math.sqrt(1+u-n-a);this._w=(o-s)/f,this._x=(r+c)/f,this._y=(l+h)/f,this._z=.25*f}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<1e-8?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=n):(this._x=0,this._y=-e.z,this._z=e.y,this._w=n)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(gt(this.dot(e),-1,1)))}rotateTowards(e,t){let n=this.angleTo(e);if(n===0)return this;let s=Math.min(1,t/n);return this.slerp(e,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x=this._x*e,this._y=this._y*e,this._z=this._z*e,this._w=this._w*e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let n=e._x,s=e._y,r=e._z,o=e._w,a=t._x,l=t._y,c=t._z,h=t._w;return this._x=n*h+o*a+s*c-r*l,this._y=s*h+o*l+r*a-n*c,this._z=r*h+o*c+n*l-s*a,this._w=o*h-n*a-s*l-r*c,this._onChangeCallback(),this}slerp(e,t){let n=e._x,s=e._y,r=e._z,o=e._w,a=this.dot(e);a<0&&(n=-n,s=-s,r=-r,o=-o,a=-a);let l=1-t;if(a<.9995){let c=Math.acos(a),h=Math.sin(c);l=Math.sin(l*c)/h,t=Math.sin(t*c)/h,this._x=this._x*l+n*t,this._y=this._y*l+s*t,this._z=this._z*l+r*t,this._w=this._w*l+o*t,this._onChangeCallback()}else this._x=this._x*l+n*t,this._y=this._y*l+s*t,this._z=this._z*l+r*t,this._w=this._w*l+o*t,this.normalize();return this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),s=Math.sqrt(1-n),r=Math.sqrt(n);return this.set(s*Math.sin(e),s*Math.cos(e),r*Math.sin(t),r*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},U=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,n=0){this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw new Error("THREE.Vector3: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(hm.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(hm.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,n=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[3]*n+r[6]*s,this.y=r[1]*t+r[4]*n+r[7]*s,this.z=r[2]*t+r[5]*n+r[8]*s,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,n=this.y,s=this.z,r=e.elements,o=1/(r[3]*t+r[7]*n+r[11]*s+r[15]);return this.x=(r[0]*t+r[4]*n+r[8]*s+r[12])*o,this.y=(r[1]*t+r[5]*n+r[9]*s+r[13])*o,this.z=(r[2]*t+r[6]*n+r[10]*s+r[14])*o,this}applyQuaternion(e){let t=this.x,n=this.y,s=this.z,r=e.x,o=e.y,a=e.z,l=e.w,c=2*(o*s-a*n),h=2*(a*t-r*s),u=2*(r*n-o*t);return this.x=t+l*c+o*u-a*h,this.y=n+l*h+a*c-r*u,this.z=s+l*u+r*h-o*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,n=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[4]*n+r[8]*s,this.y=r[1]*t+r[5]*n+r[9]*s,this.z=r[2]*t+r[6]*n+r[10]*s,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=gt(this.x,e.x,t.x),this.y=gt(this.y,e.y,t.y),this.z=gt(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=gt(this.x,e,t),this.y=gt(this.y,e,t),this.z=gt(this.z,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(gt(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let n=e.x,s=e.y,r=e.z,o=t.x,a=t.y,l=t.z;return this.x=s*l-r*a,this.y=r*o-n*l,this.z=n*a-s*o,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return cd.copy(this).projectOnVector(e),this.sub(cd)}reflect(e){return this.sub(cd.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(gt(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y,s=this.z-e.z;return t*t+n*n+s*s}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){let s=Math.sin(t)*e;return this.x=s*Math.sin(n),this.y=Math.cos(t)*e,this.z=s*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),s=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=s,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},cd=new U,hm=new Dn,it=class{static{this.prototype.isMatrix3=!0}constructor(e,t,n,s,r,o,a,l,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,s,r,o,a,l,c)}set(e,t,n,s,r,o,a,l,c){let h=this.elements;return h[0]=e,h[1]=s,h[2]=a,h[3]=t,h[4]=r,h[5]=l,h[6]=n,h[7]=o,h[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,s=t.elements,r=this.elements,o=n[0],a=n[3],l=n[6],c=n[1],h=n[4],u=n[7],d=n[2],f=n[5],m=n[8],_=s[0],g=s[3],p=s[6],y=s[1],A=s[4],S=s[7],P=s[2],E=s[5],x=s[8];return r[0]=o*_+a*y+l*P,r[3]=o*g+a*A+l*E,r[6]=o*p+a*S+l*x,r[1]=c*_+h*y+u*P,r[4]=c*g+h*A+u*E,r[7]=c*p+h*S+u*x,r[2]=d*_+f*y+m*P,r[5]=d*g+f*A+m*E,r[8]=d*p+f*S+m*x,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],h=e[8];return t*o*h-t*a*c-n*r*h+n*a*l+s*r*c-s*o*l}invert(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],h=e[8],u=h*o-a*c,d=a*l-h*r,f=c*r-o*l,m=t*u+n*d+s*f;if(m===0)return this.set(0,0,0,0,0,0,0,0,0);let _=1/m;return e[0]=u*_,e[1]=(s*c-h*n)*_,e[2]=(a*n-s*o)*_,e[3]=d*_,e[4]=(h*t-s*l)*_,e[5]=(s*r-a*t)*_,e[6]=f*_,e[7]=(n*l-c*t)*_,e[8]=(o*t-n*r)*_,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,s,r,o,a){let l=Math.cos(r),c=Math.sin(r);return this.set(n*l,n*c,-n*(l*o+c*a)+o+e,-s*c,s*l,-s*(-c*o+l*a)+a+t,0,0,1),this}scale(e,t){return ia("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(hd.makeScale(e,t)),this}rotate(e){return ia("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(hd.makeRotation(-e)),this}translate(e,t){return ia("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(hd.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,n=e.elements;for(let s=0;s<9;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}},hd=new it,um=new it().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),dm=new it().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function Ky(){let i={enabled:!0,workingColorSpace:mr,spaces:{},convert:function(s,r,o){return this.enabled===!1||r===o||!r||!o||(this.spaces[r].transfer===It&&(s.r=Ts(s.r),s.g=Ts(s.g),s.b=Ts(s.b)),this.spaces[r].primaries!==this.spaces[o].primaries&&(s.applyMatrix3(this.spaces[r].toXYZ),s.applyMatrix3(this.spaces[o].fromXYZ)),this.spaces[o].transfer===It&&(s.r=ro(s.r),s.g=ro(s.g),s.b=ro(s.b))),s},workingToColorSpace:function(s,r){return this.convert(s,this.workingColorSpace,r)},colorSpaceToWorking:function(s,r){return this.convert(s,r,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===Is?oa:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,r=this.workingColorSpace){return s.fromArray(this.spaces[r].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},_getMatrix:function(s,r,o){return s.copy(this.spaces[o].fromXYZ).multiply(this.spaces[r].toXYZ)},_getDrawingBufferColorSpace:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},e=[.64,.33,.3,.6,.15,.06],t=[.2126,.7152,.0722],n=[.3127,.329];return i.define({[mr]:{primaries:e,whitePoint:n,transfer:oa,toXYZ:um,fromXYZ:dm,luminanceCoefficients:t,workingColorSpaceConfig:{unpackColorSpace:$n},outputColorSpaceConfig:{drawingBufferColorSpace:$n}},[$n]:{primaries:e,whitePoint:n,transfer:It,toXYZ:um,fromXYZ:dm,luminanceCoefficients:t,outputColorSpaceConfig:{drawingBufferColorSpace:$n}}}),i}var yt=Ky();function Ts(i){return i<.04045?i*.0773993808:Math.pow(i*.9478672986+.0521327014,2.4)}function ro(i){return i<.0031308?i*12.92:1.055*Math.pow(i,.41666)-.055}var Wr,ec=class{static getDataURL(e,t="image/png"){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>"u")return e.src;let n;if(e instanceof HTMLCanvasElement)n=e;else{Wr===void 0&&(Wr=aa("canvas")),Wr.width=e.width,Wr.height=e.height;let s=Wr.getContext("2d");e instanceof ImageData?s.putImageData(e,0,0):s.drawImage(e,0,0,e.width,e.height),n=Wr}return n.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<"u"&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&e instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&e instanceof ImageBitmap){let t=aa("canvas");t.width=e.width,t.height=e.height;let n=t.getContext("2d");n.drawImage(e,0,0,e.width,e.height);let s=n.getImageData(0,0,e.width,e.height),r=s.data;for(let o=0;o<r.length;o++)r[o]=Ts(r[o]/255)*255;return n.putImageData(s,0,0),t}else if(e.data){let t=e.data.slice(0);for(let n=0;n<t.length;n++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[n]=Math.floor(Ts(t[n]/255)*255):t[n]=Ts(t[n]);return{data:t,width:e.width,height:e.height}}else return $e("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),e}},Jy=0,ho=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:Jy++}),this.uuid=_o(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<"u"&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<"u"&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t!==null?e.set(t.width||0,t.height||0,t.depth||0):e.set(0,0,0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let n={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let o=0,a=s.length;o<a;o++)s[o].isDataTexture?r.push(ud(s[o].image)):r.push(ud(s[o]))}else r=ud(s);n.url=r}return t||(e.images[this.uuid]=n),n}};function ud(i){return typeof HTMLImageElement<"u"&&i instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&i instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&i instanceof ImageBitmap?ec.getDataURL(i):i.data?{data:Array.from(i.data),width:i.width,height:i.height,type:i.data.constructor.name}:($e("Texture: Unable to serialize Texture."),{})}var jy=0,dd=new U,ei=class i extends ki{constructor(e=i.DEFAULT_IMAGE,t=i.DEFAULT_MAPPING,n=ts,s=ts,r=Kn,o=Ps,a=Vi,l=ni,c=i.DEFAULT_ANISOTROPY,h=Is){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:jy++}),this.uuid=_o(),this.name="",this.source=new ho(e),this.mipmaps=[],this.mapping=t,this.channel=0,this.wrapS=n,this.wrapT=s,this.magFilter=r,this.minFilter=o,this.anisotropy=c,this.format=a,this.internalFormat=null,this.type=l,this.offset=new He(0,0),this.repeat=new He(1,1),this.center=new He(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new it,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=h,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(e&&e.depth&&e.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(dd).x}get height(){return this.source.getSize(dd).y}get depth(){return this.source.getSize(dd).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let n=e[t];if(n===void 0){$e(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){$e(`Texture.setValues(): property '${t}' does not exist.`);continue}s&&n&&s.isVector2&&n.isVector2||s&&n&&s.isVector3&&n.isVector3||s&&n&&s.isMatrix3&&n.isMatrix3?s.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let n={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(e){if(this.mapping!==Jd)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case Jl:e.x=e.x-Math.floor(e.x);break;case ts:e.x=e.x<0?0:1;break;case jl:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x=e.x-Math.floor(e.x);break}if(e.y<0||e.y>1)switch(this.wrapT){case Jl:e.y=e.y-Math.floor(e.y);break;case ts:e.y=e.y<0?0:1;break;case jl:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y=e.y-Math.floor(e.y);break}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};ei.DEFAULT_IMAGE=null;ei.DEFAULT_MAPPING=Jd;ei.DEFAULT_ANISOTROPY=1;var en=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,n=0,s=1){this.x=e,this.y=t,this.z=n,this.w=s}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,s){return this.x=e,this.y=t,this.z=n,this.w=s,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw new Error("THREE.Vector4: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w!==void 0?e.w:1,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,n=this.y,s=this.z,r=this.w,o=e.elements;return this.x=o[0]*t+o[4]*n+o[8]*s+o[12]*r,this.y=o[1]*t+o[5]*n+o[9]*s+o[13]*r,this.z=o[2]*t+o[6]*n+o[10]*s+o[14]*r,this.w=o[3]*t+o[7]*n+o[11]*s+o[15]*r,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,s,r,l=e.elements,c=l[0],h=l[4],u=l[8],d=l[1],f=l[5],m=l[9],_=l[2],g=l[6],p=l[10];if(Math.abs(h-d)<.01&&Math.abs(u-_)<.01&&Math.abs(m-g)<.01){if(Math.abs(h+d)<.1&&Math.abs(u+_)<.1&&Math.abs(m+g)<.1&&Math.abs(c+f+p-3)<.1)return this.set(1,0,0,0),this;t=Math.PI;let A=(c+1)/2,S=(f+1)/2,P=(p+1)/2,E=(h+d)/4,x=(u+_)/4,T=(m+g)/4;return A>S&&A>P?A<.01?(n=0,s=.707106781,r=.707106781):(n=Math.sqrt(A),s=E/n,r=x/n):S>P?S<.01?(n=.707106781,s=0,r=.707106781):(s=Math.sqrt(S),n=E/s,r=T/s):P<.01?(n=.707106781,s=.707106781,r=0):(r=Math.sqrt(P),n=x/r,s=T/r),this.set(n,s,r,t),this}let y=Math.sqrt((g-m)*(g-m)+(u-_)*(u-_)+(d-h)*(d-h));return Math.abs(y)<.001&&(y=1),this.x=(g-m)/y,this.y=(u-_)/y,this.z=(d-h)/y,this.w=Math.acos((c+f+p-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=gt(this.x,e.x,t.x),this.y=gt(this.y,e.y,t.y),this.z=gt(this.z,e.z,t.z),this.w=gt(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=gt(this.x,e,t),this.y=gt(this.y,e,t),this.z=gt(this.z,e,t),this.w=gt(this.w,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(gt(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},tc=class extends ki{constructor(e=1,t=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:Kn,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=n.depth,this.scissor=new en(0,0,e,t),this.scissorTest=!1,this.viewport=new en(0,0,e,t),this.textures=[];let s=n.count;for(let r=0;r<s;r++)this.textures[r]=new ei({width:e,height:t,depth:n.depth}),this.textures[r].isRenderTargetTexture=!0,this.textures[r].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:Kn,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let n=0;n<this.textures.length;n++)this.textures[n].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=e,this.textures[s].image.height=t,this.textures[s].image.depth=n,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,n=e.textures.length;t<n;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let s=Object.assign({},e.textures[t].image);this.textures[t].source=new ho(s)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null)if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture;else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}},fi=class extends tc{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}},la=class extends ei{constructor(e=null,t=1,n=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=In,this.minFilter=In,this.wrapR=ts,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}};var nc=class extends ei{constructor(e=null,t=1,n=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=In,this.minFilter=In,this.wrapR=ts,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}};var dt=class i{static{this.prototype.isMatrix4=!0}constructor(e,t,n,s,r,o,a,l,c,h,u,d,f,m,_,g){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,s,r,o,a,l,c,h,u,d,f,m,_,g)}set(e,t,n,s,r,o,a,l,c,h,u,d,f,m,_,g){let p=this.elements;return p[0]=e,p[4]=t,p[8]=n,p[12]=s,p[1]=r,p[5]=o,p[9]=a,p[13]=l,p[2]=c,p[6]=h,p[10]=u,p[14]=d,p[3]=f,p[7]=m,p[11]=_,p[15]=g,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new i().fromArray(this.elements)}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){let t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),n.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,n=e.elements,s=1/Xr.setFromMatrixColumn(e,0).length(),r=1/Xr.setFromMatrixColumn(e,1).length(),o=1/Xr.setFromMatrixColumn(e,2).length();return t[0]=n[0]*s,t[1]=n[1]*s,t[2]=n[2]*s,t[3]=0,t[4]=n[4]*r,t[5]=n[5]*r,t[6]=n[6]*r,t[7]=0,t[8]=n[8]*o,t[9]=n[9]*o,t[10]=n[10]*o,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,n=e.x,s=e.y,r=e.z,o=Math.cos(n),a=Math.sin(n),l=Math.cos(s),c=Math.sin(s),h=Math.cos(r),u=Math.sin(r);if(e.order==="XYZ"){let d=o*h,f=o*u,m=a*h,_=a*u;t[0]=l*h,t[4]=-l*u,t[8]=c,t[1]=f+m*c,t[5]=d-_*c,t[9]=-a*l,t[2]=_-d*c,t[6]=m+f*c,t[10]=o*l}else if(e.order==="YXZ"){let d=l*h,f=l*u,m=c*h,_=c*u;t[0]=d+_*a,t[4]=m*a-f,t[8]=o*c,t[1]=o*u,t[5]=o*h,t[9]=-a,t[2]=f*a-m,t[6]=_+d*a,t[10]=o*l}else if(e.order==="ZXY"){let d=l*h,f=l*u,m=c*h,_=c*u;t[0]=d-_*a,t[4]=-o*u,t[8]=m+f*a,t[1]=f+m*a,t[5]=o*h,t[9]=_-d*a,t[2]=-o*c,t[6]=a,t[10]=o*l}else if(e.order==="ZYX"){let d=o*h,f=o*u,m=a*h,_=a*u;t[0]=l*h,t[4]=m*c-f,t[8]=d*c+_,t[1]=l*u,t[5]=_*c+d,t[9]=f*c-m,t[2]=-c,t[6]=a*l,t[10]=o*l}else if(e.order==="YZX"){let d=o*l,f=o*c,m=a*l,_=a*c;t[0]=l*h,t[4]=_-d*u,t[8]=m*u+f,t[1]=u,t[5]=o*h,t[9]=-a*h,t[2]=-c*h,t[6]=f*u+m,t[10]=d-_*u}else if(e.order==="XZY"){let d=o*l,f=o*c,m=a*l,_=a*c;t[0]=l*h,t[4]=-u,t[8]=c*h,t[1]=d*u+_,t[5]=o*h,t[9]=f*u-m,t[2]=m*u-f,t[6]=a*h,t[10]=_*u+d}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(Qy,e,e_)}lookAt(e,t,n){let s=this.elements;return hi.subVectors(e,t),hi.lengthSq()===0&&(hi.z=1),hi.normalize(),Gs.crossVectors(n,hi),Gs.lengthSq()===0&&(Math.abs(n.z)===1?hi.x+=1e-4:hi.z+=1e-4,hi.normalize(),Gs.crossVectors(n,hi)),Gs.normalize(),gl.crossVectors(hi,Gs),s[0]=Gs.x,s[4]=gl.x,s[8]=hi.x,s[1]=Gs.y,s[5]=gl.y,s[9]=hi.y,s[2]=Gs.z,s[6]=gl.z,s[10]=hi.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,s=t.elements,r=this.elements,o=n[0],a=n[4],l=n[8],c=n[12],h=n[1],u=n[5],d=n[9],f=n[13],m=n[2],_=n[6],g=n[10],p=n[14],y=n[3],A=n[7],S=n[11],P=n[15],E=s[0],x=s[4],T=s[8],k=s[12],D=s[1],N=s[5],z=s[9],H=s[13],I=s[2],W=s[6],$=s[10],G=s[14],ce=s[3],J=s[7],Q=s[11],se=s[15];return r[0]=o*E+a*D+l*I+c*ce,r[4]=o*x+a*N+l*W+c*J,r[8]=o*T+a*z+l*$+c*Q,r[12]=o*k+a*H+l*G+c*se,r[1]=h*E+u*D+d*I+f*ce,r[5]=h*x+u*N+d*W+f*J,r[9]=h*T+u*z+d*$+f*Q,r[13]=h*k+u*H+d*G+f*se,r[2]=m*E+_*D+g*I+p*ce,r[6]=m*x+_*N+g*W+p*J,r[10]=m*T+_*z+g*$+p*Q,r[14]=m*k+_*H+g*G+p*se,r[3]=y*E+A*D+S*I+P*ce,r[7]=y*x+A*N+S*W+P*J,r[11]=y*T+A*z+S*$+P*Q,r[15]=y*k+A*H+S*G+P*se,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[4],s=e[8],r=e[12],o=e[1],a=e[5],l=e[9],c=e[13],h=e[2],u=e[6],d=e[10],f=e[14],m=e[3],_=e[7],g=e[11],p=e[15],y=l*f-c*d,A=a*f-c*u,S=a*d-l*u,P=o*f-c*h,E=o*d-l*h,x=o*u-a*h;return t*(_*y-g*A+p*S)-n*(m*y-g*P+p*E)+s*(m*A-_*P+p*x)-r*(m*S-_*E+g*x)}determinantAffine(){let e=this.elements,t=e[0],n=e[4],s=e[8],r=e[1],o=e[5],a=e[9],l=e[2],c=e[6],h=e[10];return t*(o*h-a*c)-n*(r*h-a*l)+s*(r*c-o*l)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){let s=this.elements;return e.isVector3?(s[12]=e.x,s[13]=e.y,s[14]=e.z):(s[12]=e,s[13]=t,s[14]=n),this}invert(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],h=e[8],u=e[9],d=e[10],f=e[11],m=e[12],_=e[13],g=e[14],p=e[15],y=t*a-n*o,A=t*l-s*o,S=t*c-r*o,P=n*l-s*a,E=n*c-r*a,x=s*c-r*l,T=h*_-u*m,k=h*g-d*m,D=h*p-f*m,N=u*g-d*_,z=u*p-f*_,H=d*p-f*g,I=y*H-A*z+S*N+P*D-E*k+x*T;if(I===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let W=1/I;return e[0]=(a*H-l*z+c*N)*W,e[1]=(s*z-n*H-r*N)*W,e[2]=(_*x-g*E+p*P)*W,e[3]=(d*E-u*x-f*P)*W,e[4]=(l*D-o*H-c*k)*W,e[5]=(t*H-s*D+r*k)*W,e[6]=(g*S-m*x-p*A)*W,e[7]=(h*x-d*S+f*A)*W,e[8]=(o*z-a*D+c*T)*W,e[9]=(n*D-t*z-r*T)*W,e[10]=(m*E-_*S+p*y)*W,e[11]=(u*S-h*E-f*y)*W,e[12]=(a*k-o*N-l*T)*W,e[13]=(t*N-n*k+s*T)*W,e[14]=(_*A-m*P-g*y)*W,e[15]=(h*P-u*A+d*y)*W,this}scale(e){let t=this.elements,n=e.x,s=e.y,r=e.z;return t[0]*=n,t[4]*=s,t[8]*=r,t[1]*=n,t[5]*=s,t[9]*=r,t[2]*=n,t[6]*=s,t[10]*=r,t[3]*=n,t[7]*=s,t[11]*=r,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],s=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,s))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let n=Math.cos(t),s=Math.sin(t),r=1-n,o=e.x,a=e.y,l=e.z,c=r*o,h=r*a;return this.set(c*o+n,c*a-s*l,c*l+s*a,0,c*a+s*l,h*a+n,h*l-s*o,0,c*l-s*a,h*l+s*o,r*l*l+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,s,r,o){return this.set(1,n,r,0,e,1,o,0,t,s,1,0,0,0,0,1),this}compose(e,t,n){let s=this.elements,r=t._x,o=t._y,a=t._z,l=t._w,c=r+r,h=o+o,u=a+a,d=r*c,f=r*h,m=r*u,_=o*h,g=o*u,p=a*u,y=l*c,A=l*h,S=l*u,P=n.x,E=n.y,x=n.z;return s[0]=(1-(_+p))*P,s[1]=(f+S)*P,s[2]=(m-A)*P,s[3]=0,s[4]=(f-S)*E,s[5]=(1-(d+p))*E,s[6]=(g+y)*E,s[7]=0,s[8]=(m+A)*x,s[9]=(g-y)*x,s[10]=(1-(d+_))*x,s[11]=0,s[12]=e.x,s[13]=e.y,s[14]=e.z,s[15]=1,this}decompose(e,t,n){let s=this.elements;e.x=s[12],e.y=s[13],e.z=s[14];let r=this.determinantAffine();if(r===0)return n.set(1,1,1),t.identity(),this;let o=Xr.set(s[0],s[1],s[2]).length(),a=Xr.set(s[4],s[5],s[6]).length(),l=Xr.set(s[8],s[9],s[10]).length();r<0&&(o=-o),Fi.copy(this);let c=1/o,h=1/a,u=1/l;return Fi.elements[0]*=c,Fi.elements[1]*=c,Fi.elements[2]*=c,Fi.elements[4]*=h,Fi.elements[5]*=h,Fi.elements[6]*=h,Fi.elements[8]*=u,Fi.elements[9]*=u,Fi.elements[10]*=u,t.setFromRotationMatrix(Fi),n.x=o,n.y=a,n.z=l,this}makePerspective(e,t,n,s,r,o,a=Ti,l=!1){let c=this.elements,h=2*r/(t-e),u=2*r/(n-s),d=(t+e)/(t-e),f=(n+s)/(n-s),m,_;if(l)m=r/(o-r),_=o*r/(o-r);else if(a===Ti)m=-(o+r)/(o-r),_=-2*o*r/(o-r);else if(a===ao)m=-o/(o-r),_=-o*r/(o-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+a);return c[0]=h,c[4]=0,c[8]=d,c[12]=0,c[1]=0,c[5]=u,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=m,c[14]=_,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,n,s,r,o,a=Ti,l=!1){let c=this.elements,h=2/(t-e),u=2/(n-s),d=-(t+e)/(t-e),f=-(n+s)/(n-s),m,_;if(l)m=1/(o-r),_=o/(o-r);else if(a===Ti)m=-2/(o-r),_=-(o+r)/(o-r);else if(a===ao)m=-1/(o-r),_=-r/(o-r);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+a);return c[0]=h,c[4]=0,c[8]=0,c[12]=d,c[1]=0,c[5]=u,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=m,c[14]=_,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,n=e.elements;for(let s=0;s<16;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}},Xr=new U,Fi=new dt,Qy=new U(0,0,0),e_=new U(1,1,1),Gs=new U,gl=new U,hi=new U,fm=new dt,pm=new Dn,ns=class i{constructor(e=0,t=0,n=0,s=i.DEFAULT_ORDER){this.isEuler=!0,this._x=e,this._y=t,this._z=n,this._order=s}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,n,s=this._order){return this._x=e,this._y=t,this._z=n,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,n=!0){let s=e.elements,r=s[0],o=s[4],a=s[8],l=s[1],c=s[5],h=s[9],u=s[2],d=s[6],f=s[10];switch(t){case"XYZ":this._y=Math.asin(gt(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(-h,f),this._z=Math.atan2(-o,r)):(this._x=Math.atan2(d,c),this._z=0);break;case"YXZ":this._x=Math.asin(-gt(h,-1,1)),Math.abs(h)<.9999999?(this._y=Math.atan2(a,f),this._z=Math.atan2(l,c)):(this._y=Math.atan2(-u,r),this._z=0);break;case"ZXY":this._x=Math.asin(gt(d,-1,1)),Math.abs(d)<.9999999?(this._y=Math.atan2(-u,f),this._z=Math.atan2(-o,c)):(this._y=0,this._z=Math.atan2(l,r));break;case"ZYX":this._y=Math.asin(-gt(u,-1,1)),Math.abs(u)<.9999999?(this._x=Math.atan2(d,f),this._z=Math.atan2(l,r)):(this._x=0,this._z=Math.atan2(-o,c));break;case"YZX":this._z=Math.asin(gt(l,-1,1)),Math.abs(l)<.9999999?(this._x=Math.atan2(-h,c),this._y=Math.atan2(-u,r)):(this._x=0,this._y=Math.atan2(a,f));break;case"XZY":this._z=Math.asin(-gt(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(d,c),this._y=Math.atan2(a,r)):(this._x=Math.atan2(-h,f),this._y=0);break;default:$e("Euler: .setFromRotationMatrix() encountered an unknown order: "+t)}return this._order=t,n===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,n){return fm.makeRotationFromQuaternion(e),this.setFromRotationMatrix(fm,t,n)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return pm.setFromEuler(this),this.setFromQuaternion(pm,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};ns.DEFAULT_ORDER="XYZ";var ca=class{constructor(){this.mask=1}set(e){this.mask=(1<<e|0)>>>0}enable(e){this.mask|=1<<e|0}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e|0}disable(e){this.mask&=~(1<<e|0)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return(this.mask&(1<<e|0))!==0}},t_=0,mm=new U,qr=new Dn,ys=new dt,vl=new U,Ko=new U,n_=new U,i_=new Dn,gm=new U(1,0,0),vm=new U(0,1,0),xm=new U(0,0,1),ym={type:"added"},s_={type:"removed"},Yr={type:"childadded",child:null},fd={type:"childremoved",child:null},Fn=class i extends ki{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:t_++}),this.uuid=_o(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=i.DEFAULT_UP.clone();let e=new U,t=new ns,n=new Dn,s=new U(1,1,1);function r(){n.setFromEuler(t,!1)}function o(){t.setFromQuaternion(n,void 0,!1)}t._onChange(r),n._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:e},rotation:{configurable:!0,enumerable:!0,value:t},quaternion:{configurable:!0,enumerable:!0,value:n},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new dt},normalMatrix:{value:new it}}),this.matrix=new dt,this.matrixWorld=new dt,this.matrixAutoUpdate=i.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=i.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new ca,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return qr.setFromAxisAngle(e,t),this.quaternion.multiply(qr),this}rotateOnWorldAxis(e,t){return qr.setFromAxisAngle(e,t),this.quaternion.premultiply(qr),this}rotateX(e){return this.rotateOnAxis(gm,e)}rotateY(e){return this.rotateOnAxis(vm,e)}rotateZ(e){return this.rotateOnAxis(xm,e)}translateOnAxis(e,t){return mm.copy(e).applyQuaternion(this.quaternion),this.position.add(mm.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(gm,e)}translateY(e){return this.translateOnAxis(vm,e)}translateZ(e){return this.translateOnAxis(xm,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(ys.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?vl.copy(e):vl.set(e,t,n);let s=this.parent;this.updateWorldMatrix(!0,!1),Ko.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?ys.lookAt(Ko,vl,this.up):ys.lookAt(vl,Ko,this.up),this.quaternion.setFromRotationMatrix(ys),s&&(ys.extractRotation(s.matrixWorld),qr.setFromRotationMatrix(ys),this.quaternion.premultiply(qr.invert()))}add(e){if(arguments.length>1){for(let t=0;t<arguments.length;t++)this.add(arguments[t]);return this}return e===this?(nt("Object3D.add: object can't be added as a child of itself.",e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(ym),Yr.child=e,this.dispatchEvent(Yr),Yr.child=null):nt("Object3D.add: object not an instance of THREE.Object3D.",e),this)}remove(e){if(arguments.length>1){for(let n=0;n<arguments.length;n++)this.remove(arguments[n]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(s_),fd.child=e,this.dispatchEvent(fd),fd.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),ys.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),ys.multiply(e.parent.matrixWorld)),e.applyMatrix4(ys),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(ym),Yr.child=e,this.dispatchEvent(Yr),Yr.child=null,this}getObjectById(e){return this.getObjectByProperty("id",e)}getObjectByName(e){return this.getObjectByProperty("name",e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,s=this.children.length;n<s;n++){let o=this.children[n].getObjectByProperty(e,t);if(o!==void 0)return o}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);let s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Ko,e,n_),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Ko,i_,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,n=e.y,s=e.z,r=this.matrix.elements;r[12]+=t-r[0]*t-r[4]*n-r[8]*s,r[13]+=n-r[1]*t-r[5]*n-r[9]*s,r[14]+=s-r[2]*t-r[6]*n-r[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t,n=!1){let s=this.parent;if(e===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),t===!0){let r=this.children;for(let o=0,a=r.length;o<a;o++)r[o].updateWorldMatrix(!1,!0,n)}}toJSON(e){let t=e===void 0||typeof e=="string",n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.geometryInfo=this._geometryInfo.map(a=>({...a,boundingBox:a.boundingBox?a.boundingBox.toJSON():void 0,boundingSphere:a.boundingSphere?a.boundingSphere.toJSON():void 0})),s.instanceInfo=this._instanceInfo.map(a=>({...a})),s.availableInstanceIds=this._availableInstanceIds.slice(),s.availableGeometryIds=this._availableGeometryIds.slice(),s.nextIndexStart=this._nextIndexStart,s.nextVertexStart=this._nextVertexStart,s.geometryCount=this._geometryCount,s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.matricesTexture=this._matricesTexture.toJSON(e),s.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function r(a,l){return a[l.uuid]===void 0&&(a[l.uuid]=l.toJSON(e)),l.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(e.geometries,this.geometry);let a=this.geometry.parameters;if(a!==void 0&&a.shapes!==void 0){let l=a.shapes;if(Array.isArray(l))for(let c=0,h=l.length;c<h;c++){let u=l[c];r(e.shapes,u)}else r(e.shapes,l)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(e.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let a=[];for(let l=0,c=this.material.length;l<c;l++)a.push(r(e.materials,this.material[l]));s.material=a}else s.material=r(e.materials,this.material);if(this.children.length>0){s.children=[];for(let a=0;a<this.children.length;a++)s.children.push(this.children[a].toJSON(e).object)}if(this.animations.length>0){s.animations=[];for(let a=0;a<this.animations.length;a++){let l=this.animations[a];s.animations.push(r(e.animations,l))}}if(t){let a=o(e.geometries),l=o(e.materials),c=o(e.textures),h=o(e.images),u=o(e.shapes),d=o(e.skeletons),f=o(e.animations),m=o(e.nodes);a.length>0&&(n.geometries=a),l.length>0&&(n.materials=l),c.length>0&&(n.textures=c),h.length>0&&(n.images=h),u.length>0&&(n.shapes=u),d.length>0&&(n.skeletons=d),f.length>0&&(n.animations=f),m.length>0&&(n.nodes=m)}return n.object=s,n;function o(a){let l=[];for(let c in a){let h=a[c];delete h.metadata,l.push(h)}return l}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot!==null?e.pivot.clone():null,this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let n=0;n<e.children.length;n++){let s=e.children[n];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}};Fn.DEFAULT_UP=new U(0,1,0);Fn.DEFAULT_MATRIX_AUTO_UPDATE=!0;Fn.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var At=class extends Fn{constructor(){super(),this.isGroup=!0,this.type="Group"}},r_={type:"move"},uo=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new At,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new At,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new U,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new U),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new At,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new U,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new U,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let n of e.hand.values())this._getHandJoint(t,n)}return this.dispatchEvent({type:"connected",data:e}),this}disconnect(e){return this.dispatchEvent({type:"disconnected",data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,n){let s=null,r=null,o=null,a=this._targetRay,l=this._grip,c=this._hand;if(e&&t.session.visibilityState!=="visible-blurred"){if(c&&e.hand){o=!0;for(let _ of e.hand.values()){let g=t.getJointPose(_,n),p=this._getHandJoint(c,_);g!==null&&(p.matrix.fromArray(g.transform.matrix),p.matrix.decompose(p.position,p.quaternion,p.scale),p.matrixWorldNeedsUpdate=!0,p.jointRadius=g.radius),p.visible=g!==null}let h=c.joints["index-finger-tip"],u=c.joints["thumb-tip"],d=h.position.distanceTo(u.position),f=.02,m=.005;c.inputState.pinching&&d>f+m?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:e.handedness,target:this})):!c.inputState.pinching&&d<=f-m&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:e.handedness,target:this}))}else l!==null&&e.gripSpace&&(r=t.getPose(e.gripSpace,n),r!==null&&(l.matrix.fromArray(r.transform.matrix),l.matrix.decompose(l.position,l.quaternion,l.scale),l.matrixWorldNeedsUpdate=!0,r.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(r.linearVelocity)):l.hasLinearVelocity=!1,r.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(r.angularVelocity)):l.hasAngularVelocity=!1,l.eventsEnabled&&l.dispatchEvent({type:"gripUpdated",data:e,target:this})));a!==null&&(s=t.getPose(e.targetRaySpace,n),s===null&&r!==null&&(s=r),s!==null&&(a.matrix.fromArray(s.transform.matrix),a.matrix.decompose(a.position,a.quaternion,a.scale),a.matrixWorldNeedsUpdate=!0,s.linearVelocity?(a.hasLinearVelocity=!0,a.linearVelocity.copy(s.linearVelocity)):a.hasLinearVelocity=!1,s.angularVelocity?(a.hasAngularVelocity=!0,a.angularVelocity.copy(s.angularVelocity)):a.hasAngularVelocity=!1,this.dispatchEvent(r_)))}return a!==null&&(a.visible=s!==null),l!==null&&(l.visible=r!==null),c!==null&&(c.visible=o!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let n=new At;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}},Mg={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},Hs={h:0,s:0,l:0},xl={h:0,s:0,l:0};function pd(i,e,t){return t<0&&(t+=1),t>1&&(t-=1),t<1/6?i+(e-i)*6*t:t<1/2?e:t<2/3?i+(e-i)*6*(2/3-t):i}var qe=class{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){let s=e;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=$n){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,yt.colorSpaceToWorking(this,t),this}setRGB(e,t,n,s=yt.workingColorSpace){return this.r=e,this.g=t,this.b=n,yt.colorSpaceToWorking(this,s),this}setHSL(e,t,n,s=yt.workingColorSpace){if(e=hf(e,1),t=gt(t,0,1),n=gt(n,0,1),t===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+t):n+t-n*t,o=2*n-r;this.r=pd(o,r,e+1/3),this.g=pd(o,r,e),this.b=pd(o,r,e-1/3)}return yt.colorSpaceToWorking(this,s),this}setStyle(e,t=$n){function n(r){r!==void 0&&parseFloat(r)<1&&$e("Color: Alpha component of "+e+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(e)){let r,o=s[1],a=s[2];switch(o){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return n(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,t);if(r=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return n(r[4]),this.setRGB(Math.min(100,parseFloat(r[1]))/100,Math.min(100,parseFloat(r[2]))/100,Math.min(100,parseFloat(r[3]))/100,t);break;case"hsl":case"hsla":if(r=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return n(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,t);break;default:$e("Color: Unknown color model "+e)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(e)){let r=s[1],o=r.length;if(o===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,t);if(o===6)return this.setHex(parseInt(r,16),t);$e("Color: Invalid hex color "+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=$n){let n=Mg[e.toLowerCase()];return n!==void 0?this.setHex(n,t):$e("Color: Unknown color "+e),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=Ts(e.r),this.g=Ts(e.g),this.b=Ts(e.b),this}copyLinearToSRGB(e){return this.r=ro(e.r),this.g=ro(e.g),this.b=ro(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=$n){return yt.workingToColorSpace(Vn.copy(this),e),Math.round(gt(Vn.r*255,0,255))*65536+Math.round(gt(Vn.g*255,0,255))*256+Math.round(gt(Vn.b*255,0,255))}getHexString(e=$n){return("000000"+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=yt.workingColorSpace){yt.workingToColorSpace(Vn.copy(this),t);let n=Vn.r,s=Vn.g,r=Vn.b,o=Math.max(n,s,r),a=Math.min(n,s,r),l,c,h=(a+o)/2;if(a===o)l=0,c=0;else{let u=o-a;switch(c=h<=.5?u/(o+a):u/(2-o-a),o){case n:l=(s-r)/u+(s<r?6:0);break;case s:l=(r-n)/u+2;break;case r:l=(n-s)/u+4;break}l/=6}return e.h=l,e.s=c,e.l=h,e}getRGB(e,t=yt.workingColorSpace){return yt.workingToColorSpace(Vn.copy(this),t),e.r=Vn.r,e.g=Vn.g,e.b=Vn.b,e}getStyle(e=$n){yt.workingToColorSpace(Vn.copy(this),e);let t=Vn.r,n=Vn.g,s=Vn.b;return e!==$n?`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(s*255)})`}offsetHSL(e,t,n){return this.getHSL(Hs),this.setHSL(Hs.h+e,Hs.s+t,Hs.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(Hs),e.getHSL(xl);let n=sa(Hs.h,xl.h,t),s=sa(Hs.s,xl.s,t),r=sa(Hs.l,xl.l,t);return this.setHSL(n,s,r),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,n=this.g,s=this.b,r=e.elements;return this.r=r[0]*t+r[3]*n+r[6]*s,this.g=r[1]*t+r[4]*n+r[7]*s,this.b=r[2]*t+r[5]*n+r[8]*s,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Vn=new qe;qe.NAMES=Mg;var ha=class i{constructor(e,t=1,n=1e3){this.isFog=!0,this.name="",this.color=new qe(e),this.near=t,this.far=n}clone(){return new i(this.color,this.near,this.far)}toJSON(){return{type:"Fog",name:this.name,color:this.color.getHex(),near:this.near,far:this.far}}},ua=class extends Fn{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new ns,this.environmentIntensity=1,this.environmentRotation=new ns,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background!==null?e.background.clone():null,this.environment=e.environment!==null?e.environment.clone():null,this.fog=e.fog!==null?e.fog.clone():null,this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial!==null?e.overrideMaterial.clone():null,this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},Oi=new U,_s=new U,md=new U,bs=new U,$r=new U,Zr=new U,_m=new U,gd=new U,vd=new U,xd=new U,yd=new en,_d=new en,bd=new en,ws=class i{constructor(e=new U,t=new U,n=new U){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,s){s.subVectors(n,t),Oi.subVectors(e,t),s.cross(Oi);let r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(e,t,n,s,r){Oi.subVectors(s,t),_s.subVectors(n,t),md.subVectors(e,t);let o=Oi.dot(Oi),a=Oi.dot(_s),l=Oi.dot(md),c=_s.dot(_s),h=_s.dot(md),u=o*c-a*a;if(u===0)return r.set(0,0,0),null;let d=1/u,f=(c*l-a*h)*d,m=(o*h-a*l)*d;return r.set(1-f-m,m,f)}static containsPoint(e,t,n,s){return this.getBarycoord(e,t,n,s,bs)===null?!1:bs.x>=0&&bs.y>=0&&bs.x+bs.y<=1}static getInterpolation(e,t,n,s,r,o,a,l){return this.getBarycoord(e,t,n,s,bs)===null?(l.x=0,l.y=0,"z"in l&&(l.z=0),"w"in l&&(l.w=0),null):(l.setScalar(0),l.addScaledVector(r,bs.x),l.addScaledVector(o,bs.y),l.addScaledVector(a,bs.z),l)}static getInterpolatedAttribute(e,t,n,s,r,o){return yd.setScalar(0),_d.setScalar(0),bd.setScalar(0),yd.fromBufferAttribute(e,t),_d.fromBufferAttribute(e,n),bd.fromBufferAttribute(e,s),o.setScalar(0),o.addScaledVector(yd,r.x),o.addScaledVector(_d,r.y),o.addScaledVector(bd,r.z),o}static isFrontFacing(e,t,n,s){return Oi.subVectors(n,t),_s.subVectors(e,t),Oi.cross(_s).dot(s)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,s){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[s]),this}setFromAttributeAndIndices(e,t,n,s){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,s),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return Oi.subVectors(this.c,this.b),_s.subVectors(this.a,this.b),Oi.cross(_s).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(e){return i.getNormal(this.a,this.b,this.c,e)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(e,t){return i.getBarycoord(e,this.a,this.b,this.c,t)}getInterpolation(e,t,n,s,r){return i.getInterpolation(e,this.a,this.b,this.c,t,n,s,r)}containsPoint(e){return i.containsPoint(e,this.a,this.b,this.c)}isFrontFacing(e){return i.isFrontFacing(this.a,this.b,this.c,e)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let n=this.a,s=this.b,r=this.c,o,a;$r.subVectors(s,n),Zr.subVectors(r,n),gd.subVectors(e,n);let l=$r.dot(gd),c=Zr.dot(gd);if(l<=0&&c<=0)return t.copy(n);vd.subVectors(e,s);let h=$r.dot(vd),u=Zr.dot(vd);if(h>=0&&u<=h)return t.copy(s);let d=l*u-h*c;if(d<=0&&l>=0&&h<=0&&l-h>0)return o=l/(l-h),t.copy(n).addScaledVector($r,o);xd.subVectors(e,r);let f=$r.dot(xd),m=Zr.dot(xd);if(m>=0&&f<=m)return t.copy(r);let _=f*c-l*m;if(_<=0&&c>=0&&m<=0)return a=c/(c-m),t.copy(n).addScaledVector(Zr,a);let g=h*m-f*u;if(g<=0&&u-h>=0&&f-m>=0)return _m.subVectors(r,s),a=(u-h)/(u-h+(f-m)),t.copy(s).addScaledVector(_m,a);let p=1/(g+_+d);return o=_*p,a=d*p,t.copy(n).addScaledVector($r,o).addScaledVector(Zr,a)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},is=class{constructor(e=new U(1/0,1/0,1/0),t=new U(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(Ui.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(Ui.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let n=Ui.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let n=e.geometry;if(n!==void 0){let r=n.getAttribute("position");if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let o=0,a=r.count;o<a;o++)e.isMesh===!0?e.getVertexPosition(o,Ui):Ui.fromBufferAttribute(r,o),Ui.applyMatrix4(e.matrixWorld),this.expandByPoint(Ui);else e.boundingBox!==void 0?(e.boundingBox===null&&e.computeBoundingBox(),yl.copy(e.boundingBox)):(n.boundingBox===null&&n.computeBoundingBox(),yl.copy(n.boundingBox)),yl.applyMatrix4(e.matrixWorld),this.union(yl)}let s=e.children;for(let r=0,o=s.length;r<o;r++)this.expandByObject(s[r],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,Ui),Ui.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(Jo),_l.subVectors(this.max,Jo),Kr.subVectors(e.a,Jo),Jr.subVectors(e.b,Jo),jr.subVectors(e.c,Jo),Ws.subVectors(Jr,Kr),Xs.subVectors(jr,Jr),ur.subVectors(Kr,jr);let t=[0,-Ws.z,Ws.y,0,-Xs.z,Xs.y,0,-ur.z,ur.y,Ws.z,0,-Ws.x,Xs.z,0,-Xs.x,ur.z,0,-ur.x,-Ws.y,Ws.x,0,-Xs.y,Xs.x,0,-ur.y,ur.x,0];return!Sd(t,Kr,Jr,jr,_l)||(t=[1,0,0,0,1,0,0,0,1],!Sd(t,Kr,Jr,jr,_l))?!1:(bl.crossVectors(Ws,Xs),t=[bl.x,bl.y,bl.z],Sd(t,Kr,Jr,jr,_l))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,Ui).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(Ui).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()?this:(Ss[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),Ss[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),Ss[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),Ss[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),Ss[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),Ss[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),Ss[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),Ss[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(Ss),this)}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},Ss=[new U,new U,new U,new U,new U,new U,new U,new U],Ui=new U,yl=new is,Kr=new U,Jr=new U,jr=new U,Ws=new U,Xs=new U,ur=new U,Jo=new U,_l=new U,bl=new U,dr=new U;function Sd(i,e,t,n,s){for(let r=0,o=i.length-3;r<=o;r+=3){dr.fromArray(i,r);let a=s.x*Math.abs(dr.x)+s.y*Math.abs(dr.y)+s.z*Math.abs(dr.z),l=e.dot(dr),c=t.dot(dr),h=n.dot(dr);if(Math.max(-Math.max(l,c,h),Math.min(l,c,h))>a)return!1}return!0}var vn=new U,Sl=new He,o_=0,Qt=class extends ki{constructor(e,t,n=!1){if(super(),Array.isArray(e))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:o_++}),this.name="",this.array=e,this.itemSize=t,this.count=e!==void 0?e.length/t:0,this.normalized=n,this.usage=gg,this.updateRanges=[],this.gpuType=Ci,this.version=0,this._normalizationScale=e!==void 0?df(e):void 0}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[e+s]=t.array[n+s];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)Sl.fromBufferAttribute(this,t),Sl.applyMatrix3(e),this.setXY(t,Sl.x,Sl.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)vn.fromBufferAttribute(this,t),vn.applyMatrix3(e),this.setXYZ(t,vn.x,vn.y,vn.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)vn.fromBufferAttribute(this,t),vn.applyMatrix4(e),this.setXYZ(t,vn.x,vn.y,vn.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)vn.fromBufferAttribute(this,t),vn.applyNormalMatrix(e),this.setXYZ(t,vn.x,vn.y,vn.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)vn.fromBufferAttribute(this,t),vn.transformDirection(e),this.setXYZ(t,vn.x,vn.y,vn.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,s){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),s=this._normalize(s)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this}setXYZW(e,t,n,s,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),s=this._normalize(s),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this.array[e+3]=r,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:"dispose"})}_denormalize(e){let t=this._normalizationScale;return t!==void 0?Math.max(e/t,-1):bg(e,this.array)}_normalize(e){let t=this._normalizationScale;return t!==void 0?Math.round(e*t):Sg(e,this.array)}};var da=class extends Qt{constructor(e,t,n){super(new Uint16Array(e),t,n)}};var fa=class extends Qt{constructor(e,t,n){super(new Uint32Array(e),t,n)}};var Mt=class extends Qt{constructor(e,t,n){super(new Float32Array(e),t,n)}},a_=new is,jo=new U,Md=new U,As=class{constructor(e=new U,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let n=this.center;t!==void 0?n.copy(t):a_.setFromPoints(e).getCenter(n);let s=0;for(let r=0,o=e.length;r<o;r++)s=Math.max(s,n.distanceToSquared(e[r]));return this.radius=Math.sqrt(s),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius=this.radius*e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;jo.subVectors(e,this.center);let t=jo.lengthSq();if(t>this.radius*this.radius){let n=Math.sqrt(t),s=(n-this.radius)*.5;this.center.addScaledVector(jo,s/n),this.radius+=s}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(Md.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(jo.copy(e.center).add(Md)),this.expandByPoint(jo.copy(e.center).sub(Md))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},l_=0,wi=new dt,wd=new Fn,Qr=new U,ui=new is,Qo=new is,Ln=new U,zt=class i extends ki{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:l_++}),this.uuid=_o(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return Array.isArray(e)?this.index=new(Ny(e)?fa:da)(e,1):this.index=e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let r=new it().getNormalMatrix(e);n.applyNormalMatrix(r),n.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(e),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return wi.makeRotationFromQuaternion(e),this.applyMatrix4(wi),this}rotateX(e){return wi.makeRotationX(e),this.applyMatrix4(wi),this}rotateY(e){return wi.makeRotationY(e),this.applyMatrix4(wi),this}rotateZ(e){return wi.makeRotationZ(e),this.applyMatrix4(wi),this}translate(e,t,n){return wi.makeTranslation(e,t,n),this.applyMatrix4(wi),this}scale(e,t,n){return wi.makeScale(e,t,n),this.applyMatrix4(wi),this}lookAt(e){return wd.lookAt(e),wd.updateMatrix(),this.applyMatrix4(wd.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(Qr).negate(),this.translate(Qr.x,Qr.y,Qr.z),this}setFromPoints(e){let t=this.getAttribute("position");if(t===void 0){let n=[];for(let s=0,r=e.length;s<r;s++){let o=e[s];n.push(o.x,o.y,o.z||0)}this.setAttribute("position",new Mt(n,3))}else{let n=Math.min(e.length,t.count);for(let s=0;s<n;s++){let r=e[s];t.setXYZ(s,r.x,r.y,r.z||0)}e.length>t.count&&$e("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new is);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){nt("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new U(-1/0,-1/0,-1/0),new U(1/0,1/0,1/0));return}if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let n=0,s=t.length;n<s;n++){let r=t[n];ui.setFromBufferAttribute(r),this.morphTargetsRelative?(Ln.addVectors(this.boundingBox.min,ui.min),this.boundingBox.expandByPoint(Ln),Ln.addVectors(this.boundingBox.max,ui.max),this.boundingBox.expandByPoint(Ln)):(this.boundingBox.expandByPoint(ui.min),this.boundingBox.expandByPoint(ui.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&nt('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new As);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){nt("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new U,1/0);return}if(e){let n=this.boundingSphere.center;if(ui.setFromBufferAttribute(e),t)for(let r=0,o=t.length;r<o;r++){let a=t[r];Qo.setFromBufferAttribute(a),this.morphTargetsRelative?(Ln.addVectors(ui.min,Qo.min),ui.expandByPoint(Ln),Ln.addVectors(ui.max,Qo.max),ui.expandByPoint(Ln)):(ui.expandByPoint(Qo.min),ui.expandByPoint(Qo.max))}ui.getCenter(n);let s=0;for(let r=0,o=e.count;r<o;r++)Ln.fromBufferAttribute(e,r),s=Math.max(s,n.distanceToSquared(Ln));if(t)for(let r=0,o=t.length;r<o;r++){let a=t[r],l=this.morphTargetsRelative;for(let c=0,h=a.count;c<h;c++)Ln.fromBufferAttribute(a,c),l&&(Qr.fromBufferAttribute(e,c),Ln.add(Qr)),s=Math.max(s,n.distanceToSquared(Ln))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&nt('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){nt("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let n=t.position,s=t.normal,r=t.uv,o=this.getAttribute("tangent");(o===void 0||o.count!==n.count)&&(o=new Qt(new Float32Array(4*n.count),4),this.setAttribute("tangent",o));let a=[],l=[],c=new Uint8Array(n.count);for(let k=0;k<n.count;k++)a[k]=new U,l[k]=new U;let h=new U,u=new U,d=new U,f=new He,m=new He,_=new He,g=new U,p=new U;function y(k,D,N){c[k]=c[D]=c[N]=1,h.fromBufferAttribute(n,k),u.fromBufferAttribute(n,D),d.fromBufferAttribute(n,N),f.fromBufferAttribute(r,k),m.fromBufferAttribute(r,D),_.fromBufferAttribute(r,N),u.sub(h),d.sub(h),m.sub(f),_.sub(f);let z=1/(m.x*_.y-_.x*m.y);isFinite(z)&&(g.copy(u).multiplyScalar(_.y).addScaledVector(d,-m.y).multiplyScalar(z),p.copy(d).multiplyScalar(m.x).addScaledVector(u,-_.x).multiplyScalar(z),a[k].add(g),a[D].add(g),a[N].add(g),l[k].add(p),l[D].add(p),l[N].add(p))}let A=this.groups;A.length===0&&(A=[{start:0,count:e.count}]);for(let k=0,D=A.length;k<D;++k){let N=A[k],z=N.start,H=N.count;for(let I=z,W=z+H;I<W;I+=3)y(e.getX(I+0),e.getX(I+1),e.getX(I+2))}let S=new U,P=new U,E=new U,x=new U;function T(k){E.fromBufferAttribute(s,k),x.copy(E);let D=a[k];S.copy(D),S.sub(E.multiplyScalar(E.dot(D))).normalize(),P.crossVectors(x,D);let z=P.dot(l[k])<0?-1:1;o.setXYZW(k,S.x,S.y,S.z,z)}for(let k=0,D=n.count;k<D;++k)c[k]&&T(k);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute("position");if(t!==void 0){let n=this.getAttribute("normal");if(n===void 0||n.count!==t.count)n=new Qt(new Float32Array(t.count*3),3),this.setAttribute("normal",n);else for(let d=0,f=n.count;d<f;d++)n.setXYZ(d,0,0,0);let s=new U,r=new U,o=new U,a=new U,l=new U,c=new U,h=new U,u=new U;if(e)for(let d=0,f=e.count;d<f;d+=3){let m=e.getX(d+0),_=e.getX(d+1),g=e.getX(d+2);s.fromBufferAttribute(t,m),r.fromBufferAttribute(t,_),o.fromBufferAttribute(t,g),h.subVectors(o,r),u.subVectors(s,r),h.cross(u),a.fromBufferAttribute(n,m),l.fromBufferAttribute(n,_),c.fromBufferAttribute(n,g),a.add(h),l.add(h),c.add(h),n.setXYZ(m,a.x,a.y,a.z),n.setXYZ(_,l.x,l.y,l.z),n.setXYZ(g,c.x,c.y,c.z)}else for(let d=0,f=t.count;d<f;d+=3)s.fromBufferAttribute(t,d+0),r.fromBufferAttribute(t,d+1),o.fromBufferAttribute(t,d+2),h.subVectors(o,r),u.subVectors(s,r),h.cross(u),n.setXYZ(d+0,h.x,h.y,h.z),n.setXYZ(d+1,h.x,h.y,h.z),n.setXYZ(d+2,h.x,h.y,h.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)Ln.fromBufferAttribute(e,t),Ln.normalize(),e.setXYZ(t,Ln.x,Ln.y,Ln.z)}toNonIndexed(){function e(a,l){let c=a.array,h=a.itemSize,u=a.normalized,d=new c.constructor(l.length*h),f=0,m=0;for(let _=0,g=l.length;_<g;_++){a.isInterleavedBufferAttribute?f=l[_]*a.data.stride+a.offset:f=l[_]*h;for(let p=0;p<h;p++)d[m++]=c[f++]}return new Qt(d,h,u)}if(this.index===null)return $e("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let t=new i,n=this.index.array,s=this.attributes;for(let a in s){let l=s[a],c=e(l,n);t.setAttribute(a,c)}let r=this.morphAttributes;for(let a in r){let l=[],c=r[a];for(let h=0,u=c.length;h<u;h++){let d=c[h],f=e(d,n);l.push(f)}t.morphAttributes[a]=l}t.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let a=0,l=o.length;a<l;a++){let c=o[a];t.addGroup(c.start,c.count,c.materialIndex)}return t}toJSON(){let e={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?"BufferGeometry":this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let l=this.parameters;for(let c in l)l[c]!==void 0&&(e[c]=l[c]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let n=this.attributes;for(let l in n){let c=n[l];e.data.attributes[l]=c.toJSON(e.data)}let s={},r=!1;for(let l in this.morphAttributes){let c=this.morphAttributes[l],h=[];for(let u=0,d=c.length;u<d;u++){let f=c[u];h.push(f.toJSON(e.data))}h.length>0&&(s[l]=h,r=!0)}r&&(e.data.morphAttributes=s,e.data.morphTargetsRelative=this.morphTargetsRelative);let o=this.groups;o.length>0&&(e.data.groups=JSON.parse(JSON.stringify(o)));let a=this.boundingSphere;return a!==null&&(e.data.boundingSphere=a.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let n=e.index;n!==null&&this.setIndex(n.clone());let s=e.attributes;for(let c in s){let h=s[c];this.setAttribute(c,h.clone(t))}let r=e.morphAttributes;for(let c in r){let h=[],u=r[c];for(let d=0,f=u.length;d<f;d++)h.push(u[d].clone(t));this.morphAttributes[c]=h}this.morphTargetsRelative=e.morphTargetsRelative;let o=e.groups;for(let c=0,h=o.length;c<h;c++){let u=o[c];this.addGroup(u.start,u.count,u.materialIndex)}let a=e.boundingBox;a!==null&&(this.boundingBox=a.clone());let l=e.boundingSphere;return l!==null&&(this.boundingSphere=l.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:"dispose"})}};var Td=new U,c_=new U,h_=new it,di=class{constructor(e=new U(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,s){return this.normal.set(e,t,n),this.constant=s,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){let s=Td.subVectors(n,t).cross(c_.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(s,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,n=!0){let s=e.delta(Td),r=this.normal.dot(s);if(r===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let o=-(e.start.dot(this.normal)+this.constant)/r;return n===!0&&(o<0||o>1)?null:t.copy(e.start).addScaledVector(s,o)}intersectsLine(e){let t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let n=t||h_.getNormalMatrix(e),s=this.coplanarPoint(Td).applyMatrix4(e),r=this.normal.applyMatrix3(n).normalize();return this.constant=-s.dot(r),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},u_=0,ss=class extends ki{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:u_++}),this.uuid=_o(),this.name="",this.type="Material",this.blending=vo,this.side=ls,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=Gd,this.blendDst=Hd,this.blendEquation=br,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new qe(0,0,0),this.blendAlpha=0,this.depthFunc=oo,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=hg,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=Hl,this.stencilZFail=Hl,this.stencilZPass=Hl,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let n=e[t];if(n===void 0){$e(`Material: parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){$e(`Material: '${t}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(n):s&&s.isVector2&&n&&n.isVector2||s&&s.isEuler&&n&&n.isEuler||s&&s.isVector3&&n&&n.isVector3?s.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e=="string";t&&(e={textures:{},images:{}});let n={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(r=>r.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function s(r){let o=[];for(let a in r){let l=r[a];delete l.metadata,o.push(l)}return o}if(t){let r=s(e.textures),o=s(e.images);r.length>0&&(n.textures=r),o.length>0&&(n.images=o)}return n}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new qe().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(n=>new di().fromJSON(n))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(typeof e.vertexColors=="number"?this.vertexColors=e.vertexColors>0:this.vertexColors=e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let n=e.normalScale;Array.isArray(n)===!1&&(n=[n,n]),this.normalScale=new He().fromArray(n)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new He().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,n=null;if(t!==null){let s=t.length;n=new Array(s);for(let r=0;r!==s;++r)n[r]=t[r].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(e){e===!0&&this.version++}};var Ms=new U,Ed=new U,Ml=new U,wl=new U,gr=class{constructor(e=new U,t=new U(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,Ms)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=Ms.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(Ms.copy(this.origin).addScaledVector(this.direction,t),Ms.distanceToSquared(e))}distanceSqToSegment(e,t,n,s){Ed.copy(e).add(t).multiplyScalar(.5),Ml.copy(t).sub(e).normalize(),wl.copy(this.origin).sub(Ed);let r=e.distanceTo(t)*.5,o=-this.direction.dot(Ml),a=wl.dot(this.direction),l=-wl.dot(Ml),c=wl.lengthSq(),h=Math.abs(1-o*o),u,d,f,m;if(h>0)if(u=o*l-a,d=o*a-l,m=r*h,u>=0)if(d>=-m)if(d<=m){let _=1/h;u*=_,d*=_,f=u*(u+o*d+2*a)+d*(o*u+d+2*l)+c}else d=r,u=Math.max(0,-(o*d+a)),f=-u*u+d*(d+2*l)+c;else d=-r,u=Math.max(0,-(o*d+a)),f=-u*u+d*(d+2*l)+c;else d<=-m?(u=Math.max(0,-(-o*r+a)),d=u>0?-r:Math.min(Math.max(-r,-l),r),f=-u*u+d*(d+2*l)+c):d<=m?(u=0,d=Math.min(Math.max(-r,-l),r),f=d*(d+2*l)+c):(u=Math.max(0,-(o*r+a)),d=u>0?r:Math.min(Math.max(-r,-l),r),f=-u*u+d*(d+2*l)+c);else d=o>0?-r:r,u=Math.max(0,-(o*d+a)),f=-u*u+d*(d+2*l)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,u),s&&s.copy(Ed).addScaledVector(Ml,d),f}intersectSphere(e,t){if(e.radius<0)return null;Ms.subVectors(e.center,this.origin);let n=Ms.dot(this.direction),s=Ms.dot(Ms)-n*n,r=e.radius*e.radius;if(s>r)return null;let o=Math.sqrt(r-s),a=n-o,l=n+o;return l<0?null:a<0?this.at(l,t):this.at(a,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){let n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,s,r,o,a,l,c=1/this.direction.x,h=1/this.direction.y,u=1/this.direction.z,d=this.origin;return c>=0?(n=(e.min.x-d.x)*c,s=(e.max.x-d.x)*c):(n=(e.max.x-d.x)*c,s=(e.min.x-d.x)*c),h>=0?(r=(e.min.y-d.y)*h,o=(e.max.y-d.y)*h):(r=(e.max.y-d.y)*h,o=(e.min.y-d.y)*h),n>o||r>s||((r>n||isNaN(n))&&(n=r),(o<s||isNaN(s))&&(s=o),u>=0?(a=(e.min.z-d.z)*u,l=(e.max.z-d.z)*u):(a=(e.max.z-d.z)*u,l=(e.min.z-d.z)*u),n>l||a>s)||((a>n||n!==n)&&(n=a),(l<s||s!==s)&&(s=l),s<0)?null:this.at(n>=0?n:s,t)}intersectsBox(e){return this.intersectBox(e,Ms)!==null}intersectTriangle(e,t,n,s,r){let o=this.origin,a=this.direction,l=a.x,c=a.y,h=a.z,u=e.x-o.x,d=e.y-o.y,f=e.z-o.z,m=t.x-o.x,_=t.y-o.y,g=t.z-o.z,p=n.x-o.x,y=n.y-o.y,A=n.z-o.z,S=Math.abs(l),P=Math.abs(c),E=Math.abs(h),x,T,k,D,N,z,H,I,W,$,G,ce;if(S>=P&&S>=E?(k=l,z=u,W=m,ce=p,l>=0?(x=c,T=h,D=d,N=f,H=_,I=g,$=y,G=A):(x=h,T=c,D=f,N=d,H=g,I=_,$=A,G=y)):P>=E?(k=c,z=d,W=_,ce=y,c>=0?(x=h,T=l,D=f,N=u,H=g,I=m,$=A,G=p):(x=l,T=h,D=u,N=f,H=m,I=g,$=p,G=A)):(k=h,z=f,W=g,ce=A,h>=0?(x=l,T=c,D=u,N=d,H=m,I=_,$=p,G=y):(x=c,T=l,D=d,N=u,H=_,I=m,$=y,G=p)),k===0)return null;let J=x/k,Q=T/k,se=1/k,de=D-J*z,ue=N-Q*z,ee=H-J*W,me=I-Q*W,xe=$-J*ce,Ae=G-Q*ce,Se=xe*me-Ae*ee,We=de*Ae-ue*xe,ot=ee*ue-me*de;if(s){if(Se<0||We<0||ot<0)return null}else if((Se<0||We<0||ot<0)&&(Se>0||We>0||ot>0))return null;let Ve=Se+We+ot;if(Ve===0)return null;let mt=se*(Se*z+We*W+ot*ce);return(Ve>0?mt<0:mt>0)?null:this.at(mt/Ve,r)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},ln=class extends ss{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new qe(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new ns,this.combine=bc,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},bm=new dt,fr=new gr,Tl=new As,Sm=new U,El=new U,Al=new U,Cl=new U,Ad=new U,Rl=new U,Mm=new U,Pl=new U,ct=class extends Fn{constructor(e=new zt,t=new ln){super(),this.isMesh=!0,this.type="Mesh",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){let s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}getVertexPosition(e,t){let n=this.geometry,s=n.attributes.position,r=n.morphAttributes.position,o=n.morphTargetsRelative;t.fromBufferAttribute(s,e);let a=this.morphTargetInfluences;if(r&&a){Rl.set(0,0,0);for(let l=0,c=r.length;l<c;l++){let h=a[l],u=r[l];h!==0&&(Ad.fromBufferAttribute(u,e),o?Rl.addScaledVector(Ad,h):Rl.addScaledVector(Ad.sub(t),h))}t.add(Rl)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),Tl.copy(n.boundingSphere),Tl.applyMatrix4(r),fr.copy(e.ray).recast(e.near),!(Tl.containsPoint(fr.origin)===!1&&(fr.intersectSphere(Tl,Sm)===null||fr.origin.distanceToSquared(Sm)>(e.far-e.near)**2))&&(bm.copy(r).invert(),fr.copy(e.ray).applyMatrix4(bm),!(n.boundingBox!==null&&fr.intersectsBox(n.boundingBox)===!1)&&this._computeIntersections(e,t,fr)))}_computeIntersections(e,t,n){let s,r=this.geometry,o=this.material,a=r.index,l=r.attributes.position,c=r.attributes.uv,h=r.attributes.uv1,u=r.attributes.normal,d=r.groups,f=r.drawRange;if(a!==null)if(Array.isArray(o))for(let m=0,_=d.length;m<_;m++){let g=d[m],p=o[g.materialIndex],y=Math.max(g.start,f.start),A=Math.min(a.count,Math.min(g.start+g.count,f.start+f.count));for(let S=y,P=A;S<P;S+=3){let E=a.getX(S),x=a.getX(S+1),T=a.getX(S+2);s=Ll(this,p,e,n,c,h,u,E,x,T),s&&(s.faceIndex=Math.floor(S/3),s.face.materialIndex=g.materialIndex,t.push(s))}}else{let m=Math.max(0,f.start),_=Math.min(a.count,f.start+f.count);for(let g=m,p=_;g<p;g+=3){let y=a.getX(g),A=a.getX(g+1),S=a.getX(g+2);s=Ll(this,o,e,n,c,h,u,y,A,S),s&&(s.faceIndex=Math.floor(g/3),t.push(s))}}else if(l!==void 0)if(Array.isArray(o))for(let m=0,_=d.length;m<_;m++){let g=d[m],p=o[g.materialIndex],y=Math.max(g.start,f.start),A=Math.min(l.count,Math.min(g.start+g.count,f.start+f.count));for(let S=y,P=A;S<P;S+=3){let E=S,x=S+1,T=S+2;s=Ll(this,p,e,n,c,h,u,E,x,T),s&&(s.faceIndex=Math.floor(S/3),s.face.materialIndex=g.materialIndex,t.push(s))}}else{let m=Math.max(0,f.start),_=Math.min(l.count,f.start+f.count);for(let g=m,p=_;g<p;g+=3){let y=g,A=g+1,S=g+2;s=Ll(this,o,e,n,c,h,u,y,A,S),s&&(s.faceIndex=Math.floor(g/3),t.push(s))}}}};function d_(i,e,t,n,s,r,o,a){let l;if(e.side===Un?l=n.intersectTriangle(o,r,s,!0,a):l=n.intersectTriangle(s,r,o,e.side===ls,a),l===null)return null;Pl.copy(a),Pl.applyMatrix4(i.matrixWorld);let c=t.ray.origin.distanceTo(Pl);return c<t.near||c>t.far?null:{distance:c,point:Pl.clone(),object:i}}function Ll(i,e,t,n,s,r,o,a,l,c){i.getVertexPosition(a,El),i.getVertexPosition(l,Al),i.getVertexPosition(c,Cl);let h=d_(i,e,t,n,El,Al,Cl,Mm);if(h){let u=new U;ws.getBarycoord(Mm,El,Al,Cl,u),s&&(h.uv=ws.getInterpolatedAttribute(s,a,l,c,u,new He)),r&&(h.uv1=ws.getInterpolatedAttribute(r,a,l,c,u,new He)),o&&(h.normal=ws.getInterpolatedAttribute(o,a,l,c,u,new U),h.normal.dot(n.direction)>0&&h.normal.multiplyScalar(-1));let d={a,b:l,c,normal:new U,materialIndex:0};ws.getNormal(El,Al,Cl,d.normal),h.face=d,h.barycoord=u}return h}var pa=class extends ei{constructor(e=null,t=1,n=1,s,r,o,a,l,c=In,h=In,u,d){super(null,o,a,l,c,h,s,r,u,d),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var fo=class extends Qt{constructor(e,t,n,s=1){super(e,t,n),this.isInstancedBufferAttribute=!0,this.meshPerAttribute=s}copy(e){return super.copy(e),this.meshPerAttribute=e.meshPerAttribute,this}toJSON(){let e=super.toJSON();return e.meshPerAttribute=this.meshPerAttribute,e.isInstancedBufferAttribute=!0,e}},eo=new dt,wm=new dt,Il=[],Tm=new is,f_=new dt,ea=new ct,ta=new As,ma=class extends ct{constructor(e,t,n){super(e,t),this.isInstancedMesh=!0,this.instanceMatrix=new fo(new Float32Array(n*16),16),this.instanceColor=null,this.morphTexture=null,this.count=n,this.boundingBox=null,this.boundingSphere=null;for(let s=0;s<n;s++)this.setMatrixAt(s,f_)}computeBoundingBox(){let e=this.geometry,t=this.count;this.boundingBox===null&&(this.boundingBox=new is),e.boundingBox===null&&e.computeBoundingBox(),this.boundingBox.makeEmpty();for(let n=0;n<t;n++)this.getMatrixAt(n,eo),Tm.copy(e.boundingBox).applyMatrix4(eo),this.boundingBox.union(Tm)}computeBoundingSphere(){let e=this.geometry,t=this.count;this.boundingSphere===null&&(this.boundingSphere=new As),e.boundingSphere===null&&e.computeBoundingSphere(),this.boundingSphere.makeEmpty();for(let n=0;n<t;n++)this.getMatrixAt(n,eo),ta.copy(e.boundingSphere).applyMatrix4(eo),this.boundingSphere.union(ta)}copy(e,t){return super.copy(e,t),this.instanceMatrix.copy(e.instanceMatrix),this.morphTexture=e.morphTexture!==null?e.morphTexture.clone():null,this.instanceColor=e.instanceColor!==null?e.instanceColor.clone():null,this.count=e.count,this.boundingBox=e.boundingBox!==null?e.boundingBox.clone():null,this.boundingSphere=e.boundingSphere!==null?e.boundingSphere.clone():null,this}getColorAt(e,t){return this.instanceColor===null?t.setRGB(1,1,1):t.fromArray(this.instanceColor.array,e*3)}getMatrixAt(e,t){return t.fromArray(this.instanceMatrix.array,e*16)}getMorphAt(e,t){let n=t.morphTargetInfluences,s=this.morphTexture.source.data.data,r=n.length+1,o=e*r+1;for(let a=0;a<n.length;a++)n[a]=s[o+a]}raycast(e,t){let n=this.matrixWorld,s=this.count;if(ea.geometry=this.geometry,ea.material=this.material,ea.material!==void 0&&(this.boundingSphere===null&&this.computeBoundingSphere(),ta.copy(this.boundingSphere),ta.applyMatrix4(n),e.ray.intersectsSphere(ta)!==!1))for(let r=0;r<s;r++){this.getMatrixAt(r,eo),wm.multiplyMatrices(n,eo),ea.matrixWorld=wm,ea.raycast(e,Il);for(let o=0,a=Il.length;o<a;o++){let l=Il[o];l.instanceId=r,l.object=this,t.push(l)}Il.length=0}}setColorAt(e,t){return this.instanceColor===null&&(this.instanceColor=new fo(new Float32Array(this.instanceMatrix.count*3).fill(1),3)),t.toArray(this.instanceColor.array,e*3),this}setMatrixAt(e,t){return t.toArray(this.instanceMatrix.array,e*16),this}setMorphAt(e,t){let n=t.morphTargetInfluences,s=n.length+1;this.morphTexture===null&&(this.morphTexture=new pa(new Float32Array(s*this.count),s,this.count,Cc,Ci));let r=this.morphTexture.source.data.data,o=0;for(let c=0;c<n.length;c++)o+=n[c];let a=this.geometry.morphTargetsRelative?1:1-o,l=s*e;return r[l]=a,r.set(n,l+1),this}updateMorphTargets(){}dispose(){super.dispose(),this.instanceMatrix.dispose(),this.instanceColor!==null&&this.instanceColor.dispose(),this.morphTexture!==null&&(this.morphTexture.dispose(),this.morphTexture=null)}},pr=new As,p_=new He(.5,.5),Nl=new U,Ys=class{constructor(e=new di,t=new di,n=new di,s=new di,r=new di,o=new di){this.planes=[e,t,n,s,r,o]}set(e,t,n,s,r,o){let a=this.planes;return a[0].copy(e),a[1].copy(t),a[2].copy(n),a[3].copy(s),a[4].copy(r),a[5].copy(o),this}copy(e){let t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=Ti,n=!1){let s=this.planes,r=e.elements,o=r[0],a=r[1],l=r[2],c=r[3],h=r[4],u=r[5],d=r[6],f=r[7],m=r[8],_=r[9],g=r[10],p=r[11],y=r[12],A=r[13],S=r[14],P=r[15];if(s[0].setComponents(c-o,f-h,p-m,P-y).normalize(),s[1].setComponents(c+o,f+h,p+m,P+y).normalize(),s[2].setComponents(c+a,f+u,p+_,P+A).normalize(),s[3].setComponents(c-a,f-u,p-_,P-A).normalize(),n)s[4].setComponents(l,d,g,S).normalize(),s[5].setComponents(c-l,f-d,p-g,P-S).normalize();else if(s[4].setComponents(c-l,f-d,p-g,P-S).normalize(),t===Ti)s[5].setComponents(c+l,f+d,p+g,P+S).normalize();else if(t===ao)s[5].setComponents(l,d,g,S).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),pr.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),pr.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(pr)}intersectsSprite(e){pr.center.set(0,0,0);let t=p_.distanceTo(e.center);return pr.radius=.7071067811865476+t,pr.applyMatrix4(e.matrixWorld),this.intersectsSphere(pr)}intersectsSphere(e){let t=this.planes,n=e.center,s=-e.radius;for(let r=0;r<6;r++)if(t[r].distanceToPoint(n)<s)return!1;return!0}intersectsBox(e){let t=this.planes;for(let n=0;n<6;n++){let s=t[n];if(Nl.x=s.normal.x>0?e.max.x:e.min.x,Nl.y=s.normal.y>0?e.max.y:e.min.y,Nl.z=s.normal.z>0?e.max.z:e.min.z,s.distanceToPoint(Nl)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},Em=new dt,ic=class i{constructor(){this.coordinateSystem=Ti,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,n=this._frustums;for(let s=0;s<t.length;s++){let r=t[s];Em.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[s]===void 0&&(n[s]=new Ys),n[s].setFromProjectionMatrix(Em,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,n=e._frustums;for(let s=0;s<e._count;s++)t[s]===void 0&&(t[s]=new Ys),t[s].copy(n[s]);return this._count=e._count,this}clone(){return new i().copy(this)}};var pi=class extends ss{constructor(e){super(),this.isLineBasicMaterial=!0,this.type="LineBasicMaterial",this.color=new qe(16777215),this.map=null,this.linewidth=1,this.linecap="round",this.linejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.linewidth=e.linewidth,this.linecap=e.linecap,this.linejoin=e.linejoin,this.fog=e.fog,this}},sc=new U,rc=new U,Am=new dt,na=new gr,Dl=new As,Cd=new U,Cm=new U,rs=class extends Fn{constructor(e=new zt,t=new pi){super(),this.isLine=!0,this.type="Line",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[0];for(let s=1,r=t.count;s<r;s++)sc.fromBufferAttribute(t,s-1),rc.fromBufferAttribute(t,s),n[s]=n[s-1],n[s]+=sc.distanceTo(rc);e.setAttribute("lineDistance",new Mt(n,1))}else $e("Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,s=this.matrixWorld,r=e.params.Line.threshold,o=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),Dl.copy(n.boundingSphere),Dl.applyMatrix4(s),Dl.radius+=r,e.ray.intersectsSphere(Dl)===!1)return;Am.copy(s).invert(),na.copy(e.ray).applyMatrix4(Am);let a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=this.isLineSegments?2:1,h=n.index,d=n.attributes.position;if(h!==null){let f=Math.max(0,o.start),m=Math.min(h.count,o.start+o.count);for(let _=f,g=m-1;_<g;_+=c){let p=h.getX(_),y=h.getX(_+1),A=Fl(this,e,na,l,p,y,_);A&&t.push(A)}if(this.isLineLoop){let _=h.getX(m-1),g=h.getX(f),p=Fl(this,e,na,l,_,g,m-1);p&&t.push(p)}}else{let f=Math.max(0,o.start),m=Math.min(d.count,o.start+o.count);for(let _=f,g=m-1;_<g;_+=c){let p=Fl(this,e,na,l,_,_+1,_);p&&t.push(p)}if(this.isLineLoop){let _=Fl(this,e,na,l,m-1,f,m-1);_&&t.push(_)}}}updateMorphTargets(){let t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){let s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}};function Fl(i,e,t,n,s,r,o){let a=i.geometry.attributes.position;if(sc.fromBufferAttribute(a,s),rc.fromBufferAttribute(a,r),t.distanceSqToSegment(sc,rc,Cd,Cm)>n)return;Cd.applyMatrix4(i.matrixWorld);let c=e.ray.origin.distanceTo(Cd);if(!(c<e.near||c>e.far))return{distance:c,point:Cm.clone().applyMatrix4(i.matrixWorld),index:o,face:null,faceIndex:null,barycoord:null,object:i}}var Rm=new U,Pm=new U,os=class extends rs{constructor(e,t){super(e,t),this.isLineSegments=!0,this.type="LineSegments"}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[];for(let s=0,r=t.count;s<r;s+=2)Rm.fromBufferAttribute(t,s),Pm.fromBufferAttribute(t,s+1),n[s]=s===0?0:n[s-1],n[s+1]=n[s]+Rm.distanceTo(Pm);e.setAttribute("lineDistance",new Mt(n,1))}else $e("LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}};var ga=class extends ei{constructor(e=[],t=Sr,n,s,r,o,a,l,c,h){super(e,t,n,s,r,o,a,l,c,h),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}};var Cs=class extends ei{constructor(e,t,n=Bi,s,r,o,a=In,l=In,c,h=Es,u=1){if(h!==Es&&h!==Ls)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");let d={width:e,height:t,depth:u};super(d,s,r,o,a,l,h,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new ho(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},va=class extends Cs{constructor(e,t=Bi,n=Sr,s,r,o=In,a=In,l,c=Es){let h={width:e,height:e,depth:1},u=[h,h,h,h,h,h];super(e,e,t,n,s,r,o,a,l,c),this.image=u,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},xa=class extends ei{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},ti=class i extends zt{constructor(e=1,t=1,n=1,s=1,r=1,o=1){super(),this.type="BoxGeometry",this.parameters={width:e,height:t,depth:n,widthSegments:s,heightSegments:r,depthSegments:o};let a=this;s=Math.floor(s),r=Math.floor(r),o=Math.floor(o);let l=[],c=[],h=[],u=[],d=0,f=0;m("z","y","x",-1,-1,n,t,e,o,r,0),m("z","y","x",1,-1,n,t,-e,o,r,1),m("x","z","y",1,1,e,n,t,s,o,2),m("x","z","y",1,-1,e,n,-t,s,o,3),m("x","y","z",1,-1,e,t,n,s,r,4),m("x","y","z",-1,-1,e,t,-n,s,r,5),this.setIndex(l),this.setAttribute("position",new Mt(c,3)),this.setAttribute("normal",new Mt(h,3)),this.setAttribute("uv",new Mt(u,2));function m(_,g,p,y,A,S,P,E,x,T,k){let D=S/x,N=P/T,z=S/2,H=P/2,I=E/2,W=x+1,$=T+1,G=0,ce=0,J=new U;for(let Q=0;Q<$;Q++){let se=Q*N-H;for(let de=0;de<W;de++){let ue=de*D-z;J[_]=ue*y,J[g]=se*A,J[p]=I,c.push(J.x,J.y,J.z),J[_]=0,J[g]=0,J[p]=E>0?1:-1,h.push(J.x,J.y,J.z),u.push(de/x),u.push(1-Q/T),G+=1}}for(let Q=0;Q<T;Q++)for(let se=0;se<x;se++){let de=d+se+W*Q,ue=d+se+W*(Q+1),ee=d+(se+1)+W*(Q+1),me=d+(se+1)+W*Q;l.push(de,ue,me),l.push(ue,ee,me),ce+=6}a.addGroup(f,ce,k),f+=ce,d+=G}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.width,e.height,e.depth,e.widthSegments,e.heightSegments,e.depthSegments)}};var ya=class i extends zt{constructor(e=1,t=32,n=0,s=Math.PI*2){super(),this.type="CircleGeometry",this.parameters={radius:e,segments:t,thetaStart:n,thetaLength:s},t=Math.max(3,t);let r=[],o=[],a=[],l=[],c=new U,h=new He;o.push(0,0,0),a.push(0,0,1),l.push(.5,.5);for(let u=0,d=3;u<=t;u++,d+=3){let f=n+u/t*s;c.x=e*Math.cos(f),c.y=e*Math.sin(f),o.push(c.x,c.y,c.z),a.push(0,0,1),h.x=(o[d]/e+1)/2,h.y=(o[d+1]/e+1)/2,l.push(h.x,h.y)}for(let u=1;u<=t;u++)r.push(u,u+1,0);this.setIndex(r),this.setAttribute("position",new Mt(o,3)),this.setAttribute("normal",new Mt(a,3)),this.setAttribute("uv",new Mt(l,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.radius,e.segments,e.thetaStart,e.thetaLength)}},Ei=class i extends zt{constructor(e=1,t=1,n=1,s=32,r=1,o=!1,a=0,l=Math.PI*2){super(),this.type="CylinderGeometry",this.parameters={radiusTop:e,radiusBottom:t,height:n,radialSegments:s,heightSegments:r,openEnded:o,thetaStart:a,thetaLength:l};let c=this;s=Math.floor(s),r=Math.floor(r);let h=[],u=[],d=[],f=[],m=0,_=[],g=n/2,p=0;y(),o===!1&&(e>0&&A(!0),t>0&&A(!1)),this.setIndex(h),this.setAttribute("position",new Mt(u,3)),this.setAttribute("normal",new Mt(d,3)),this.setAttribute("uv",new Mt(f,2));function y(){let S=new U,P=new U,E=0,x=(t-e)/n;for(let T=0;T<=r;T++){let k=[],D=T/r,N=D*(t-e)+e;for(let z=0;z<=s;z++){let H=z/s,I=H*l+a,W=Math.sin(I),$=Math.cos(I);P.x=N*W,P.y=-D*n+g,P.z=N*$,u.push(P.x,P.y,P.z),S.set(W,x,$).normalize(),d.push(S.x,S.y,S.z),f.push(H,1-D),k.push(m++)}_.push(k)}for(let T=0;T<s;T++)for(let k=0;k<r;k++){let D=_[k][T],N=_[k+1][T],z=_[k+1][T+1],H=_[k][T+1];(e>0||k!==0)&&(h.push(D,N,H),E+=3),(t>0||k!==r-1)&&(h.push(N,z,H),E+=3)}c.addGroup(p,E,0),p+=E}function A(S){let P=m,E=new He,x=new U,T=0,k=S===!0?e:t,D=S===!0?1:-1;for(let z=1;z<=s;z++)u.push(0,g*D,0),d.push(0,D,0),f.push(.5,.5),m++;let N=m;for(let z=0;z<=s;z++){let I=z/s*l+a,W=Math.cos(I),$=Math.sin(I);x.x=k*$,x.y=g*D,x.z=k*W,u.push(x.x,x.y,x.z),d.push(0,D,0),E.x=W*.5+.5,E.y=$*.5*D+.5,f.push(E.x,E.y),m++}for(let z=0;z<s;z++){let H=P+z,I=N+z;S===!0?h.push(I,I+1,H):h.push(I+1,I,H),T+=3}c.addGroup(p,T,S===!0?1:2),p+=T}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.radiusTop,e.radiusBottom,e.height,e.radialSegments,e.heightSegments,e.openEnded,e.thetaStart,e.thetaLength)}},Rs=class i extends Ei{constructor(e=1,t=1,n=32,s=1,r=!1,o=0,a=Math.PI*2){super(0,e,t,n,s,r,o,a),this.type="ConeGeometry",this.parameters={radius:e,height:t,radialSegments:n,heightSegments:s,openEnded:r,thetaStart:o,thetaLength:a}}static fromJSON(e){return new i(e.radius,e.height,e.radialSegments,e.heightSegments,e.openEnded,e.thetaStart,e.thetaLength)}};var Ol=new U,Ul=new U,Rd=new U,kl=new ws,vr=class extends zt{constructor(e=null,t=1){if(super(),this.type="EdgesGeometry",this.parameters={geometry:e,thresholdAngle:t},e!==null){let s=Math.pow(10,4),r=Math.cos(so*t),o=e.getIndex(),a=e.getAttribute("position"),l=o?o.count:a.count,c=[0,0,0],h=["a","b","c"],u=new Array(3),d=new Map,f=[];for(let m=0;m<l;m+=3){o?(c[0]=o.getX(m),c[1]=o.getX(m+1),c[2]=o.getX(m+2)):(c[0]=m,c[1]=m+1,c[2]=m+2);let{a:_,b:g,c:p}=kl;if(_.fromBufferAttribute(a,c[0]),g.fromBufferAttribute(a,c[1]),p.fromBufferAttribute(a,c[2]),kl.getNormal(Rd),u[0]=`${Math.round(_.x*s)},${Math.round(_.y*s)},${Math.round(_.z*s)}`,u[1]=`${Math.round(g.x*s)},${Math.round(g.y*s)},${Math.round(g.z*s)}`,u[2]=`${Math.round(p.x*s)},${Math.round(p.y*s)},${Math.round(p.z*s)}`,!(u[0]===u[1]||u[1]===u[2]||u[2]===u[0]))for(let y=0;y<3;y++){let A=(y+1)%3,S=u[y],P=u[A],E=kl[h[y]],x=kl[h[A]],T=`${S}_${P}`,k=`${P}_${S}`,D=d.get(k);D?(Rd.dot(D.normal)<=r&&(f.push(E.x,E.y,E.z),f.push(x.x,x.y,x.z)),d.set(k,null)):d.has(T)||d.set(T,{index0:c[y],index1:c[A],normal:Rd.clone()})}}for(let m of d.values())if(m){let{index0:_,index1:g}=m;Ol.fromBufferAttribute(a,_),Ul.fromBufferAttribute(a,g),f.push(Ol.x,Ol.y,Ol.z),f.push(Ul.x,Ul.y,Ul.z)}this.setAttribute("position",new Mt(f,3))}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}};var _a=class i extends zt{constructor(e=[new He(0,-.5),new He(.5,0),new He(0,.5)],t=12,n=0,s=Math.PI*2){super(),this.type="LatheGeometry",this.parameters={points:e,segments:t,phiStart:n,phiLength:s},t=Math.floor(t),s=gt(s,0,Math.PI*2);let r=[],o=[],a=[],l=[],c=[],h=1/t,u=new U,d=new He,f=new U,m=new U,_=new U,g=0,p=0;for(let y=0;y<=e.length-1;y++)switch(y){case 0:g=e[y+1].x-e[y].x,p=e[y+1].y-e[y].y,f.x=p*1,f.y=-g,f.z=p*0,_.copy(f),f.normalize(),l.push(f.x,f.y,f.z);break;case e.length-1:_.normalize(),l.push(_.x,_.y,_.z);break;default:g=e[y+1].x-e[y].x,p=e[y+1].y-e[y].y,f.x=p*1,f.y=-g,f.z=p*0,m.copy(f),f.x+=_.x,f.y+=_.y,f.z+=_.z,f.normalize(),l.push(f.x,f.y,f.z),_.copy(m)}for(let y=0;y<=t;y++){let A=n+y*h*s,S=Math.sin(A),P=Math.cos(A);for(let E=0;E<=e.length-1;E++){u.x=e[E].x*S,u.y=e[E].y,u.z=e[E].x*P,o.push(u.x,u.y,u.z),d.x=y/t,d.y=E/(e.length-1),a.push(d.x,d.y);let x=l[3*E+0]*S,T=l[3*E+1],k=l[3*E+0]*P;c.push(x,T,k)}}for(let y=0;y<t;y++)for(let A=0;A<e.length-1;A++){let S=A+y*e.length,P=S,E=S+e.length,x=S+e.length+1,T=S+1;r.push(P,E,T),r.push(x,T,E)}this.setIndex(r),this.setAttribute("position",new Mt(o,3)),this.setAttribute("uv",new Mt(a,2)),this.setAttribute("normal",new Mt(c,3))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.points,e.segments,e.phiStart,e.phiLength)}};var xr=class i extends zt{constructor(e=1,t=1,n=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:e,height:t,widthSegments:n,heightSegments:s};let r=e/2,o=t/2,a=Math.floor(n),l=Math.floor(s),c=a+1,h=l+1,u=e/a,d=t/l,f=[],m=[],_=[],g=[];for(let p=0;p<h;p++){let y=p*d-o;for(let A=0;A<c;A++){let S=A*u-r;m.push(S,-y,0),_.push(0,0,1),g.push(A/a),g.push(1-p/l)}}for(let p=0;p<l;p++)for(let y=0;y<a;y++){let A=y+c*p,S=y+c*(p+1),P=y+1+c*(p+1),E=y+1+c*p;f.push(A,S,E),f.push(S,P,E)}this.setIndex(f),this.setAttribute("position",new Mt(m,3)),this.setAttribute("normal",new Mt(_,3)),this.setAttribute("uv",new Mt(g,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.width,e.height,e.widthSegments,e.heightSegments)}};var Jn=class i extends zt{constructor(e=1,t=32,n=16,s=0,r=Math.PI*2,o=0,a=Math.PI){super(),this.type="SphereGeometry",this.parameters={radius:e,widthSegments:t,heightSegments:n,phiStart:s,phiLength:r,thetaStart:o,thetaLength:a},t=Math.max(3,Math.floor(t)),n=Math.max(2,Math.floor(n));let l=Math.min(o+a,Math.PI),c=0,h=[],u=new U,d=new U,f=[],m=[],_=[],g=[];for(let p=0;p<=n;p++){let y=[],A=p/n,S=o+A*a,P=e*Math.cos(S),E=Math.sqrt(e*e-P*P),x=0;p===0&&o===0?x=.5/t:p===n&&l===Math.PI&&(x=-.5/t);for(let T=0;T<=t;T++){let k=T/t,D=s+k*r;u.x=-E*Math.cos(D),u.y=P,u.z=E*Math.sin(D),m.push(u.x,u.y,u.z),d.copy(u).normalize(),_.push(d.x,d.y,d.z),g.push(k+x,1-A),y.push(c++)}h.push(y)}for(let p=0;p<n;p++)for(let y=0;y<t;y++){let A=h[p][y+1],S=h[p][y],P=h[p+1][y],E=h[p+1][y+1];(p!==0||o>0)&&f.push(A,S,E),(p!==n-1||l<Math.PI)&&f.push(S,P,E)}this.setIndex(f),this.setAttribute("position",new Mt(m,3)),this.setAttribute("normal",new Mt(_,3)),this.setAttribute("uv",new Mt(g,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.radius,e.widthSegments,e.heightSegments,e.phiStart,e.phiLength,e.thetaStart,e.thetaLength)}};var $s=class i extends zt{constructor(e=1,t=.4,n=12,s=48,r=Math.PI*2,o=0,a=Math.PI*2){super(),this.type="TorusGeometry",this.parameters={radius:e,tube:t,radialSegments:n,tubularSegments:s,arc:r,thetaStart:o,thetaLength:a},n=Math.floor(n),s=Math.floor(s);let l=[],c=[],h=[],u=[],d=new U,f=new U,m=new U;for(let _=0;_<=n;_++){let g=o+_/n*a;for(let p=0;p<=s;p++){let y=p/s*r;f.x=(e+t*Math.cos(g))*Math.cos(y),f.y=(e+t*Math.cos(g))*Math.sin(y),f.z=t*Math.sin(g),c.push(f.x,f.y,f.z),d.x=e*Math.cos(y),d.y=e*Math.sin(y),m.subVectors(f,d).normalize(),h.push(m.x,m.y,m.z),u.push(p/s),u.push(_/n)}}for(let _=1;_<=n;_++)for(let g=1;g<=s;g++){let p=(s+1)*_+g-1,y=(s+1)*(_-1)+g-1,A=(s+1)*(_-1)+g,S=(s+1)*_+g;l.push(p,y,S),l.push(y,A,S)}this.setIndex(l),this.setAttribute("position",new Mt(c,3)),this.setAttribute("normal",new Mt(h,3)),this.setAttribute("uv",new Mt(u,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.radius,e.tube,e.radialSegments,e.tubularSegments,e.arc,e.thetaStart,e.thetaLength)}};function wr(i){let e={};for(let t in i){e[t]={};for(let n in i[t]){let s=i[t][n];if(Lm(s))s.isRenderTargetTexture?($e("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),e[t][n]=null):e[t][n]=s.clone();else if(Array.isArray(s))if(Lm(s[0])){let r=[];for(let o=0,a=s.length;o<a;o++)r[o]=s[o].clone();e[t][n]=r}else e[t][n]=s.slice();else e[t][n]=s}}return e}function Gn(i){let e={};for(let t=0;t<i.length;t++){let n=wr(i[t]);for(let s in n)e[s]=n[s]}return e}function Lm(i){return i&&(i.isColor||i.isMatrix3||i.isMatrix4||i.isVector2||i.isVector3||i.isVector4||i.isTexture||i.isQuaternion)}function m_(i){let e=[];for(let t=0;t<i.length;t++)e.push(i[t].clone());return e}function ff(i){let e=i.getRenderTarget();return e===null?i.outputColorSpace:e.isXRRenderTarget===!0?e.texture.colorSpace:yt.workingColorSpace}var wg={clone:wr,merge:Gn},g_=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,v_=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,as=class extends ss{constructor(e){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=g_,this.fragmentShader=v_,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=wr(e.uniforms),this.uniformsGroups=m_(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let s in this.uniforms){let o=this.uniforms[s].value;o&&o.isTexture?t.uniforms[s]={type:"t",value:o.toJSON(e).uuid}:o&&o.isColor?t.uniforms[s]={type:"c",value:o.getHex()}:o&&o.isVector2?t.uniforms[s]={type:"v2",value:o.toArray()}:o&&o.isVector3?t.uniforms[s]={type:"v3",value:o.toArray()}:o&&o.isVector4?t.uniforms[s]={type:"v4",value:o.toArray()}:o&&o.isMatrix3?t.uniforms[s]={type:"m3",value:o.toArray()}:o&&o.isMatrix4?t.uniforms[s]={type:"m4",value:o.toArray()}:t.uniforms[s]={value:o}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let n={};for(let s in this.extensions)this.extensions[s]===!0&&(n[s]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let n in e.uniforms){let s=e.uniforms[n];switch(this.uniforms[n]={},s.type){case"t":this.uniforms[n].value=t[s.value]||null;break;case"c":this.uniforms[n].value=new qe().setHex(s.value);break;case"v2":this.uniforms[n].value=new He().fromArray(s.value);break;case"v3":this.uniforms[n].value=new U().fromArray(s.value);break;case"v4":this.uniforms[n].value=new en().fromArray(s.value);break;case"m3":this.uniforms[n].value=new it().fromArray(s.value);break;case"m4":this.uniforms[n].value=new dt().fromArray(s.value);break;default:this.uniforms[n].value=s.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let n in e.extensions)this.extensions[n]=e.extensions[n];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},oc=class extends as{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}},ba=class extends ss{constructor(e){super(),this.isMeshStandardMaterial=!0,this.type="MeshStandardMaterial",this.defines={STANDARD:""},this.color=new qe(16777215),this.roughness=1,this.metalness=0,this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new qe(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=Oa,this.normalScale=new He(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.roughnessMap=null,this.metalnessMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new ns,this.envMapIntensity=1,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.flatShading=!1,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.defines={STANDARD:""},this.color.copy(e.color),this.roughness=e.roughness,this.metalness=e.metalness,this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.emissive.copy(e.emissive),this.emissiveMap=e.emissiveMap,this.emissiveIntensity=e.emissiveIntensity,this.bumpMap=e.bumpMap,this.bumpScale=e.bumpScale,this.normalMap=e.normalMap,this.normalMapType=e.normalMapType,this.normalScale.copy(e.normalScale),this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.roughnessMap=e.roughnessMap,this.metalnessMap=e.metalnessMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.envMapIntensity=e.envMapIntensity,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.flatShading=e.flatShading,this.fog=e.fog,this}};var On=class extends ss{constructor(e){super(),this.isMeshLambertMaterial=!0,this.type="MeshLambertMaterial",this.color=new qe(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new qe(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=Oa,this.normalScale=new He(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new ns,this.combine=bc,this.reflectivity=1,this.envMapIntensity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.flatShading=!1,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.emissive.copy(e.emissive),this.emissiveMap=e.emissiveMap,this.emissiveIntensity=e.emissiveIntensity,this.bumpMap=e.bumpMap,this.bumpScale=e.bumpScale,this.normalMap=e.normalMap,this.normalMapType=e.normalMapType,this.normalScale.copy(e.normalScale),this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.envMapIntensity=e.envMapIntensity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.flatShading=e.flatShading,this.fog=e.fog,this}},ac=class extends ss{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=lg,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},lc=class extends ss{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function to(i,e){return!i||i.constructor===e?i:typeof e.BYTES_PER_ELEMENT=="number"?new e(i):Array.prototype.slice.call(i)}function Bl(i){return i!==void 0&&i.inTangents!==void 0&&i.outTangents!==void 0}var Zs=class{constructor(e,t,n,s){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=s!==void 0?s:new t.constructor(n),this.sampleValues=t,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,n=this._cachedIndex,s=t[n],r=t[n-1];e:{t:{let o;n:{i:if(!(e<s)){for(let a=n+2;;){if(s===void 0){if(e<r)break i;return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===a)break;if(r=s,s=t[++n],e<s)break t}o=t.length;break n}if(!(e>=r)){let a=t[1];e<a&&(n=2,r=a);for(let l=n-2;;){if(r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===l)break;if(s=r,r=t[--n-1],e>=r)break t}o=n,n=0;break n}break e}for(;n<o;){let a=n+o>>>1;e<t[a]?o=a:n=a+1}if(s=t[n],r=t[n-1],r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(s===void 0)return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,r,s)}return this.interpolate_(n,r,e,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,s=this.valueSize,r=e*s;for(let o=0;o!==s;++o)t[o]=n[r+o];return t}interpolate_(){throw new Error("THREE.Interpolant: Call to abstract method.")}intervalChanged_(){}},cc=class extends Zs{constructor(e,t,n,s){super(e,t,n,s),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:Id,endingEnd:Id}}intervalChanged_(e,t,n){let s=this.parameterPositions,r=e-2,o=e+1,a=s[r],l=s[o];if(a===void 0)switch(this.getSettings_().endingStart){case Nd:r=e,a=2*t-n;break;case Dd:r=s.length-2,a=t+s[r]-s[r+1];break;default:r=e,a=n}if(l===void 0)switch(this.getSettings_().endingEnd){case Nd:o=e,l=2*n-t;break;case Dd:o=1,l=n+s[1]-s[0];break;default:o=e-1,l=t}let c=(n-t)*.5,h=this.valueSize;this._weightPrev=c/(t-a),this._weightNext=c/(l-n),this._offsetPrev=r*h,this._offsetNext=o*h}interpolate_(e,t,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,h=this._offsetPrev,u=this._offsetNext,d=this._weightPrev,f=this._weightNext,m=(n-t)/(s-t),_=m*m,g=_*m,p=-d*g+2*d*_-d*m,y=(1+d)*g+(-1.5-2*d)*_+(-.5+d)*m+1,A=(-1-f)*g+(1.5+f)*_+.5*m,S=f*g-f*_;for(let P=0;P!==a;++P)r[P]=p*o[h+P]+y*o[c+P]+A*o[l+P]+S*o[u+P];return r}},hc=class extends Zs{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e,t,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,h=(n-t)/(s-t),u=1-h;for(let d=0;d!==a;++d)r[d]=o[c+d]*u+o[l+d]*h;return r}},uc=class extends Zs{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e){return this.copySampleValue_(e-1)}},dc=class extends Zs{interpolate_(e,t,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,h=this.inTangents,u=this.outTangents;if(!h||!u){let m=(n-t)/(s-t),_=1-m;for(let g=0;g!==a;++g)r[g]=o[c+g]*_+o[l+g]*m;return r}let d=a*2,f=e-1;for(let m=0;m!==a;++m){let _=o[c+m],g=o[l+m],p=f*d+m*2,y=u[p],A=u[p+1],S=e*d+m*2,P=h[S],E=h[S+1],x=y_(n,t,y,P,s);r[m]=Tg(x,_,A,E,g)}return r}};function Tg(i,e,t,n,s){let r=1-i;return r*r*r*e+3*r*r*i*t+3*r*i*i*n+i*i*i*s}function x_(i,e,t,n,s){let r=1-i;return 3*r*r*(t-e)+6*r*i*(n-t)+3*i*i*(s-n)}function y_(i,e,t,n,s){let r=(i-e)/(s-e);for(let o=0;o<8;o++){let a=Tg(r,e,t,n,s)-i;if(Math.abs(a)<1e-10)break;let l=x_(r,e,t,n,s);if(Math.abs(l)<1e-10)break;r=Math.max(0,Math.min(1,r-a/l))}return r}var mi=class{constructor(e,t,n,s){if(e===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(t===void 0||t.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+e);this.name=e,this.times=to(t,this.TimeBufferType),this.values=to(n,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,n;if(t.toJSON!==this.toJSON)n=t.toJSON(e);else{n={name:e.name,times:to(e.times,Array),values:to(e.values,Array)};let s=e.getInterpolation();s!==e.DefaultInterpolation&&(n.interpolation=s),Bl(e.settings)&&(n.settings={inTangents:to(e.settings.inTangents,Array),outTangents:to(e.settings.outTangents,Array)})}return n.type=e.ValueTypeName,n}InterpolantFactoryMethodDiscrete(e){return new uc(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new hc(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new cc(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new dc(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case ra:t=this.InterpolantFactoryMethodDiscrete;break;case Ql:t=this.InterpolantFactoryMethodLinear;break;case Gl:t=this.InterpolantFactoryMethodSmooth;break;case Ld:t=this.InterpolantFactoryMethodBezier;break}if(t===void 0){let n="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(n);return $e("KeyframeTrack:",n),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return ra;case this.InterpolantFactoryMethodLinear:return Ql;case this.InterpolantFactoryMethodSmooth:return Gl;case this.InterpolantFactoryMethodBezier:return Ld}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let n=0,s=t.length;n!==s;++n)t[n]+=e;Bl(this.settings)&&(Im(this.settings.inTangents,e),Im(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let n=0,s=t.length;n!==s;++n)t[n]*=e;Bl(this.settings)&&(Nm(this.settings.inTangents,e),Nm(this.settings.outTangents,e))}return this}trim(e,t){let n=this.times,s=n.length,r=0,o=s-1;for(;r!==s&&n[r]<e;)++r;for(;o!==-1&&n[o]>t;)--o;if(++o,r!==0||o!==s){r>=o&&(o=Math.max(o,1),r=o-1);let a=this.getValueSize();this.times=n.slice(r,o),this.values=this.values.slice(r*a,o*a)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(nt("KeyframeTrack: Invalid value size in track.",this),e=!1);let n=this.times,s=this.values,r=n.length;r===0&&(nt("KeyframeTrack: Track is empty.",this),e=!1);let o=null;for(let a=0;a!==r;a++){let l=n[a];if(typeof l=="number"&&isNaN(l)){nt("KeyframeTrack: Time is not a valid number.",this,a,l),e=!1;break}if(o!==null&&o>l){nt("KeyframeTrack: Out of order keys.",this,a,l,o),e=!1;break}o=l}if(s!==void 0&&Dy(s))for(let a=0,l=s.length;a!==l;++a){let c=s[a];if(isNaN(c)){nt("KeyframeTrack: Value is not a valid number.",this,a,c),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),n=this.getValueSize(),s=this.getInterpolation()===Gl,r=e.length-1,o=1;for(let a=1;a<r;++a){let l=!1,c=e[a],h=e[a+1];if(c!==h&&(a!==1||c!==e[0]))if(s)l=!0;else{let u=a*n,d=u-n,f=u+n;for(let m=0;m!==n;++m){let _=t[u+m];if(_!==t[d+m]||_!==t[f+m]){l=!0;break}}}if(l){if(a!==o){e[o]=e[a];let u=a*n,d=o*n;for(let f=0;f!==n;++f)t[d+f]=t[u+f]}++o}}if(r>0){e[o]=e[r];for(let a=r*n,l=o*n,c=0;c!==n;++c)t[l+c]=t[a+c];++o}return o!==e.length?(this.times=e.slice(0,o),this.values=t.slice(0,o*n)):(this.times=e,this.values=t),this}clone(){let e=this.times.slice(),t=this.values.slice(),n=this.constructor,s=new n(this.name,e,t);return s.createInterpolant=this.createInterpolant,Bl(this.settings)&&(s.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),s}};function Im(i,e){for(let t=0,n=i.length;t!==n;t+=2)i[t]+=e}function Nm(i,e){for(let t=0,n=i.length;t!==n;t+=2)i[t]*=e}mi.prototype.ValueTypeName="";mi.prototype.TimeBufferType=Float32Array;mi.prototype.ValueBufferType=Float32Array;mi.prototype.DefaultInterpolation=Ql;var Ks=class extends mi{constructor(e,t,n){super(e,t,n)}};Ks.prototype.ValueTypeName="bool";Ks.prototype.ValueBufferType=Array;Ks.prototype.DefaultInterpolation=ra;Ks.prototype.InterpolantFactoryMethodLinear=void 0;Ks.prototype.InterpolantFactoryMethodSmooth=void 0;var fc=class extends mi{constructor(e,t,n,s){super(e,t,n,s)}};fc.prototype.ValueTypeName="color";var pc=class extends mi{constructor(e,t,n,s){super(e,t,n,s)}};pc.prototype.ValueTypeName="number";var mc=class extends Zs{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e,t,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=(n-t)/(s-t),c=e*a;for(let h=c+a;c!==h;c+=4)Dn.slerpFlat(r,0,o,c-a,o,c,l);return r}},Sa=class extends mi{constructor(e,t,n,s){super(e,t,n,s)}InterpolantFactoryMethodLinear(e){return new mc(this.times,this.values,this.getValueSize(),e)}};Sa.prototype.ValueTypeName="quaternion";Sa.prototype.InterpolantFactoryMethodSmooth=void 0;var Js=class extends mi{constructor(e,t,n){super(e,t,n)}};Js.prototype.ValueTypeName="string";Js.prototype.ValueBufferType=Array;Js.prototype.DefaultInterpolation=ra;Js.prototype.InterpolantFactoryMethodLinear=void 0;Js.prototype.InterpolantFactoryMethodSmooth=void 0;var gc=class extends mi{constructor(e,t,n,s){super(e,t,n,s)}};gc.prototype.ValueTypeName="vector";var vc=class{constructor(e,t,n){let s=this,r=!1,o=0,a=0,l,c=[];this.onStart=void 0,this.onLoad=e,this.onProgress=t,this.onError=n,this._abortController=null,this.itemStart=function(h){a++,r===!1&&s.onStart!==void 0&&s.onStart(h,o,a),r=!0},this.itemEnd=function(h){o++,s.onProgress!==void 0&&s.onProgress(h,o,a),o===a&&(r=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(h){s.onError!==void 0&&s.onError(h)},this.resolveURL=function(h){return h=h.normalize("NFC"),l?l(h):h},this.setURLModifier=function(h){return l=h,this},this.addHandler=function(h,u){return c.push(h,u),this},this.removeHandler=function(h){let u=c.indexOf(h);return u!==-1&&c.splice(u,2),this},this.getHandler=function(h){for(let u=0,d=c.length;u<d;u+=2){let f=c[u],m=c[u+1];if(f.global&&(f.lastIndex=0),f.test(h))return m}return null},this.abort=function(){return this.abortController.abort(),this._abortController=null,this}}get abortController(){return this._abortController||(this._abortController=new AbortController),this._abortController}},Eg=new vc,xc=class{constructor(e){this.manager=e!==void 0?e:Eg,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={},this.priority="auto",this.cache="default",typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}load(){}loadAsync(e,t){let n=this;return new Promise(function(s,r){n.load(e,s,t,r)})}parse(){}setCrossOrigin(e){return this.crossOrigin=e,this}setWithCredentials(e){return this.withCredentials=e,this}setPath(e){return this.path=e,this}setResourcePath(e){return this.resourcePath=e,this}setRequestHeader(e){return this.requestHeader=e,this}setPriority(e){return this.priority=e,this}setCache(e){return this.cache=e,this}abort(){return this}};xc.DEFAULT_MATERIAL_NAME="__DEFAULT";var Ma=class extends Fn{static registerNode(e){this.prototype._lightNode=e}constructor(e,t=1){super(),this.isLight=!0,this.type="Light",this.color=new qe(e),this.intensity=t}copy(e,t){return super.copy(e,t),this.color.copy(e.color),this.intensity=e.intensity,this}toJSON(e){let t=super.toJSON(e);return t.object.color=this.color.getHex(),t.object.intensity=this.intensity,t}},wa=class extends Ma{constructor(e,t,n){super(e,n),this.isHemisphereLight=!0,this.type="HemisphereLight",this.position.copy(Fn.DEFAULT_UP),this.updateMatrix(),this.groundColor=new qe(t)}copy(e,t){return super.copy(e,t),this.groundColor.copy(e.groundColor),this}toJSON(e){let t=super.toJSON(e);return t.object.groundColor=this.groundColor.getHex(),t}},Pd=new dt,Dm=new U,Fm=new U,yc=class{constructor(e){this.camera=e,this.intensity=1,this.bias=0,this.biasNode=null,this.normalBias=0,this.radius=1,this.blurSamples=8,this.mapSize=new He(512,512),this.mapType=ni,this.map=null,this.mapPass=null,this.matrix=new dt,this.autoUpdate=!0,this.needsUpdate=!1,this._frustum=new Ys,this._frameExtents=new He(1,1),this._viewportCount=1,this._viewports=[new en(0,0,1,1)]}getViewportCount(){return this._viewportCount}getCamera(){return this.camera}getFrustum(){return this._frustum}updateMatrices(e){let t=this.camera;Dm.setFromMatrixPosition(e.matrixWorld),t.position.copy(Dm),Fm.setFromMatrixPosition(e.target.matrixWorld),t.lookAt(Fm),t.updateMatrixWorld(),this._updateMatrix(t,this.matrix,this._frustum)}_updateMatrix(e,t,n,s){Pd.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),n.setFromProjectionMatrix(Pd,e.coordinateSystem,e.reversedDepth);let r=this._frameExtents,o=s?s.z/r.x:1,a=s?s.w/r.y:1,l=s?s.x/r.x:0,c=s?s.y/r.y:0;e.coordinateSystem===ao||e.reversedDepth?t.set(.5*o,0,0,.5*o+l,0,.5*a,0,.5*a+c,0,0,1,0,0,0,0,1):t.set(.5*o,0,0,.5*o+l,0,.5*a,0,.5*a+c,0,0,.5,.5,0,0,0,1),t.multiply(Pd)}getViewport(e){return this._viewports[e]}getFrameExtents(){return this._frameExtents}dispose(){this.map&&this.map.dispose(),this.mapPass&&this.mapPass.dispose()}copy(e){return this.camera=e.camera.clone(),this.intensity=e.intensity,this.bias=e.bias,this.radius=e.radius,this.autoUpdate=e.autoUpdate,this.needsUpdate=e.needsUpdate,this.normalBias=e.normalBias,this.blurSamples=e.blurSamples,this.mapSize.copy(e.mapSize),this.mapType=e.mapType,this.biasNode=e.biasNode,this}clone(){return new this.constructor().copy(this)}toJSON(){let e={};return e.intensity=this.intensity,e.bias=this.bias,e.normalBias=this.normalBias,e.radius=this.radius,e.blurSamples=this.blurSamples,e.mapSize=this.mapSize.toArray(),e.mapType=this.mapType,e.camera=this.camera.toJSON(!1).object,delete e.camera.matrix,e}},zl=new U,Vl=new Dn,es=new U,Ta=class extends Fn{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new dt,this.projectionMatrix=new dt,this.projectionMatrixInverse=new dt,this.coordinateSystem=Ti,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(zl,Vl,es),es.x===1&&es.y===1&&es.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(zl,Vl,es.set(1,1,1)).invert()}updateWorldMatrix(e,t,n=!1){super.updateWorldMatrix(e,t,n),this.matrixWorld.decompose(zl,Vl,es),es.x===1&&es.y===1&&es.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(zl,Vl,es.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},qs=new U,Om=new He,Um=new He,Zn=class extends Ta{constructor(e=50,t=1,n=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=e,this.zoom=1,this.near=n,this.far=s,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=co*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(so*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return co*2*Math.atan(Math.tan(so*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){qs.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(qs.x,qs.y).multiplyScalar(-e/qs.z),qs.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(qs.x,qs.y).multiplyScalar(-e/qs.z)}getViewSize(e,t){return this.getViewBounds(e,Om,Um),t.subVectors(Um,Om)}setViewOffset(e,t,n,s,r,o){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(so*.5*this.fov)/this.zoom,n=2*t,s=this.aspect*n,r=-.5*s,o=this.view;if(this.view!==null&&this.view.enabled){let l=o.fullWidth,c=o.fullHeight;r+=o.offsetX*s/l,t-=o.offsetY*n/c,s*=o.width/l,n*=o.height/c}let a=this.filmOffset;a!==0&&(r+=e*a/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,t,t-n,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}};var Ea=class extends Ta{constructor(e=-1,t=1,n=1,s=-1,r=.1,o=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=s,this.near=r,this.far=o,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,s,r,o){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,s=(this.top+this.bottom)/2,r=n-e,o=n+e,a=s+t,l=s-t;if(this.view!==null&&this.view.enabled){let c=(this.right-this.left)/this.view.fullWidth/this.zoom,h=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,o=r+c*this.view.width,a-=h*this.view.offsetY,l=a-h*this.view.height}this.projectionMatrix.makeOrthographic(r,o,a,l,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}},Fd=class extends yc{constructor(){super(new Ea(-5,5,5,-5,.5,500)),this.isDirectionalLightShadow=!0}},Aa=class extends Ma{constructor(e,t){super(e,t),this.isDirectionalLight=!0,this.type="DirectionalLight",this.position.copy(Fn.DEFAULT_UP),this.updateMatrix(),this.target=new Fn,this.shadow=new Fd}dispose(){super.dispose(),this.shadow.dispose()}copy(e){return super.copy(e),this.target=e.target.clone(),this.shadow=e.shadow.clone(),this}toJSON(e){let t=super.toJSON(e);return t.object.shadow=this.shadow.toJSON(),t.object.target=this.target.uuid,t}};var no=-90,io=1,po=class extends Fn{constructor(e,t,n){super(),this.type="CubeCamera",this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new Zn(no,io,e,t);s.layers=this.layers,this.add(s);let r=new Zn(no,io,e,t);r.layers=this.layers,this.add(r);let o=new Zn(no,io,e,t);o.layers=this.layers,this.add(o);let a=new Zn(no,io,e,t);a.layers=this.layers,this.add(a);let l=new Zn(no,io,e,t);l.layers=this.layers,this.add(l);let c=new Zn(no,io,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[n,s,r,o,a,l]=t;for(let c of t)this.remove(c);if(e===Ti)n.up.set(0,1,0),n.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),o.up.set(0,0,1),o.lookAt(0,-1,0),a.up.set(0,1,0),a.lookAt(0,0,1),l.up.set(0,1,0),l.lookAt(0,0,-1);else if(e===ao)n.up.set(0,-1,0),n.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),o.up.set(0,0,-1),o.lookAt(0,-1,0),a.up.set(0,-1,0),a.lookAt(0,0,1),l.up.set(0,-1,0),l.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+e);for(let c of t)this.add(c),c.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:s}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[r,o,a,l,c,h]=this.children,u=e.getRenderTarget(),d=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),m=e.xr.enabled;e.xr.enabled=!1;let _=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let g=!1;e.isWebGLRenderer===!0?g=e.state.buffers.depth.getReversed():g=e.reversedDepthBuffer,e.setRenderTarget(n,0,s),g&&e.autoClear===!1&&e.clearDepth(),e.render(t,r),e.setRenderTarget(n,1,s),g&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(n,2,s),g&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(n,3,s),g&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(n,4,s),g&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),n.texture.mipmapsAutoUpdate=_,e.setRenderTarget(n,5,s),g&&e.autoClear===!1&&e.clearDepth(),e.render(t,h),e.setRenderTarget(u,d,f),e.xr.enabled=m,n.texture.needsPMREMUpdate=!0}},_c=class extends Zn{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}};var pf="\\[\\]\\.:\\/",__=new RegExp("["+pf+"]","g"),mf="[^"+pf+"]",b_="[^"+pf.replace("\\.","")+"]",S_=/((?:WC+[\/:])*)/.source.replace("WC",mf),M_=/(WCOD+)?/.source.replace("WCOD",b_),w_=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",mf),T_=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",mf),E_=new RegExp("^"+S_+M_+w_+T_+"$"),A_=["material","materials","bones","map"],Od=class{constructor(e,t,n){let s=n||$t.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,s)}getValue(e,t){this.bind();let n=this._targetGroup.nCachedObjects_,s=this._bindings[n];s!==void 0&&s.getValue(e,t)}setValue(e,t){let n=this._bindings;for(let s=this._targetGroup.nCachedObjects_,r=n.length;s!==r;++s)n[s].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].unbind()}},$t=class i{constructor(e,t,n){this.path=t,this.parsedPath=n||i.parseTrackName(t),this.node=i.findNode(e,this.parsedPath.nodeName),this.rootNode=e,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(e,t,n){return e&&e.isAnimationObjectGroup?new i.Composite(e,t,n):new i(e,t,n)}static sanitizeNodeName(e){return e.replace(/\s/g,"_").replace(__,"")}static parseTrackName(e){let t=E_.exec(e);if(t===null)throw new Error("THREE.PropertyBinding: Cannot parse trackName: "+e);let n={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},s=n.nodeName&&n.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let r=n.nodeName.substring(s+1);A_.indexOf(r)!==-1&&(n.nodeName=n.nodeName.substring(0,s),n.objectName=r)}if(n.propertyName===null||n.propertyName.length===0)throw new Error("THREE.PropertyBinding: can not parse propertyName from trackName: "+e);return n}static findNode(e,t){if(t===void 0||t===""||t==="."||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let n=e.skeleton.getBoneByName(t);if(n!==void 0)return n}if(e.children){let n=function(r){for(let o=0;o<r.length;o++){let a=r[o];if(a.name===t||a.uuid===t)return a;let l=n(a.children);if(l)return l}return null},s=n(e.children);if(s)return s}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)e[t++]=n[s]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let e=this.node,t=this.parsedPath,n=t.objectName,s=t.propertyName,r=t.propertyIndex;if(e||(e=i.findNode(this.rootNode,t.nodeName),this.node=e),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!e){$e("PropertyBinding: No target node found for track: "+this.path+".");return}if(n){let c=t.objectIndex;switch(n){case"materials":if(!e.material){nt("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.materials){nt("PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}e=e.material.materials;break;case"bones":if(!e.skeleton){nt("PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}e=e.skeleton.bones;for(let h=0;h<e.length;h++)if(e[h].name===c){c=h;break}break;case"map":if("map"in e){e=e.map;break}if(!e.material){nt("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.map){nt("PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}e=e.material.map;break;default:if(e[n]===void 0){nt("PropertyBinding: Can not bind to objectName of node undefined.",this);return}e=e[n]}if(c!==void 0){if(e[c]===void 0){nt("PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,e);return}e=e[c]}}let o=e[s];if(o===void 0){let c=t.nodeName;nt("PropertyBinding: Trying to update property for track: "+c+"."+s+" but it wasn't found.",e);return}let a=this.Versioning.None;this.targetObject=e,e.isMaterial===!0?a=this.Versioning.NeedsUpdate:e.isObject3D===!0&&(a=this.Versioning.MatrixWorldNeedsUpdate);let l=this.BindingType.Direct;if(r!==void 0){if(s==="morphTargetInfluences"){if(!e.geometry){nt("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!e.geometry.morphAttributes){nt("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}e.morphTargetDictionary[r]!==void 0&&(r=e.morphTargetDictionary[r])}l=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=r}else o.fromArray!==void 0&&o.toArray!==void 0?(l=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(l=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=s;this.getValue=this.GetterByBindingType[l],this.setValue=this.SetterByBindingTypeAndVersioning[l][a]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};$t.Composite=Od;$t.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};$t.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};$t.prototype.GetterByBindingType=[$t.prototype._getValue_direct,$t.prototype._getValue_array,$t.prototype._getValue_arrayElement,$t.prototype._getValue_toArray];$t.prototype.SetterByBindingTypeAndVersioning=[[$t.prototype._setValue_direct,$t.prototype._setValue_direct_setNeedsUpdate,$t.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[$t.prototype._setValue_array,$t.prototype._setValue_array_setNeedsUpdate,$t.prototype._setValue_array_setMatrixWorldNeedsUpdate],[$t.prototype._setValue_arrayElement,$t.prototype._setValue_arrayElement_setNeedsUpdate,$t.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[$t.prototype._setValue_fromArray,$t.prototype._setValue_fromArray_setNeedsUpdate,$t.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var fP=new Float32Array(1);var mo=class{constructor(e=1,t=0,n=0){this.radius=e,this.phi=t,this.theta=n}set(e,t,n){return this.radius=e,this.phi=t,this.theta=n,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){return this.phi=gt(this.phi,1e-6,Math.PI-1e-6),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,n){return this.radius=Math.sqrt(e*e+t*t+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,n),this.phi=Math.acos(gt(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};var Ud=class{static{this.prototype.isMatrix2=!0}constructor(e,t,n,s){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,n,s)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let n=0;n<4;n++)this.elements[n]=e[n+t];return this}set(e,t,n,s){let r=this.elements;return r[0]=e,r[2]=t,r[1]=n,r[3]=s,this}};var Ca=class extends ki{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function gf(i,e,t,n){let s=C_(n);switch(t){case nf:return i*e;case Cc:return i*e/s.components*s.byteLength;case Rc:return i*e/s.components*s.byteLength;case er:return i*e*2/s.components*s.byteLength;case Pc:return i*e*2/s.components*s.byteLength;case sf:return i*e*3/s.components*s.byteLength;case Vi:return i*e*4/s.components*s.byteLength;case Lc:return i*e*4/s.components*s.byteLength;case Pa:case La:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case Ia:case Na:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Nc:case Fc:return Math.max(i,16)*Math.max(e,8)/4;case Ic:case Dc:return Math.max(i,8)*Math.max(e,8)/2;case Oc:case Uc:case Bc:case zc:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case kc:case Da:case Vc:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Gc:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Hc:return Math.floor((i+4)/5)*Math.floor((e+3)/4)*16;case Wc:return Math.floor((i+4)/5)*Math.floor((e+4)/5)*16;case Xc:return Math.floor((i+5)/6)*Math.floor((e+4)/5)*16;case qc:return Math.floor((i+5)/6)*Math.floor((e+5)/6)*16;case Yc:return Math.floor((i+7)/8)*Math.floor((e+4)/5)*16;case $c:return Math.floor((i+7)/8)*Math.floor((e+5)/6)*16;case Zc:return Math.floor((i+7)/8)*Math.floor((e+7)/8)*16;case Kc:return Math.floor((i+9)/10)*Math.floor((e+4)/5)*16;case Jc:return Math.floor((i+9)/10)*Math.floor((e+5)/6)*16;case jc:return Math.floor((i+9)/10)*Math.floor((e+7)/8)*16;case Qc:return Math.floor((i+9)/10)*Math.floor((e+9)/10)*16;case eh:return Math.floor((i+11)/12)*Math.floor((e+9)/10)*16;case th:return Math.floor((i+11)/12)*Math.floor((e+11)/12)*16;case nh:case ih:case sh:return Math.ceil(i/4)*Math.ceil(e/4)*16;case rh:case oh:return Math.ceil(i/4)*Math.ceil(e/4)*8;case Fa:case ah:return Math.ceil(i/4)*Math.ceil(e/4)*16}throw new Error(`Unable to determine texture byte length for ${t} format.`)}function C_(i){switch(i){case ni:case jd:return{byteLength:1,components:1};case yo:case Qd:case zi:return{byteLength:2,components:1};case Ec:case Ac:return{byteLength:2,components:4};case Bi:case Tc:case Ci:return{byteLength:4,components:1};case ef:case tf:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${i}.`)}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:"187"}}));typeof window<"u"&&(window.__THREE__?$e("WARNING: Multiple instances of Three.js being imported."):window.__THREE__="187");function $g(){let i=null,e=!1,t=null,n=null;function s(r,o){n=i.requestAnimationFrame(s),t(r,o)}return{start:function(){e!==!0&&t!==null&&i!==null&&(n=i.requestAnimationFrame(s),e=!0)},stop:function(){i!==null&&i.cancelAnimationFrame(n),e=!1},setAnimationLoop:function(r){t=r},setContext:function(r){i=r}}}function F_(i){let e=new WeakMap;function t(a,l){let c=a.array,h=a.usage,u=c.byteLength,d=i.createBuffer();i.bindBuffer(l,d),i.bufferData(l,c,h),a.onUploadCallback();let f;if(c instanceof Float32Array)f=i.FLOAT;else if(typeof Float16Array<"u"&&c instanceof Float16Array)f=i.HALF_FLOAT;else if(c instanceof Uint16Array)a.isFloat16BufferAttribute?f=i.HALF_FLOAT:f=i.UNSIGNED_SHORT;else if(c instanceof Int16Array)f=i.SHORT;else if(c instanceof Uint32Array)f=i.UNSIGNED_INT;else if(c instanceof Int32Array)f=i.INT;else if(c instanceof Int8Array)f=i.BYTE;else if(c instanceof Uint8Array)f=i.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)f=i.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:d,type:f,bytesPerElement:c.BYTES_PER_ELEMENT,version:a.version,size:u}}function n(a,l,c){let h=l.array,u=l.updateRanges;if(i.bindBuffer(c,a),u.length===0)i.bufferSubData(c,0,h);else{u.sort((f,m)=>f.start-m.start);let d=0;for(let f=1;f<u.length;f++){let m=u[d],_=u[f];_.start<=m.start+m.count+1?m.count=Math.max(m.count,_.start+_.count-m.start):(++d,u[d]=_)}u.length=d+1;for(let f=0,m=u.length;f<m;f++){let _=u[f];i.bufferSubData(c,_.start*h.BYTES_PER_ELEMENT,h,_.start,_.count)}l.clearUpdateRanges()}l.onUploadCallback()}function s(a){return a.isInterleavedBufferAttribute&&(a=a.data),e.get(a)}function r(a){a.isInterleavedBufferAttribute&&(a=a.data);let l=e.get(a);l&&(i.deleteBuffer(l.buffer),e.delete(a))}function o(a,l){if(a.isInterleavedBufferAttribute&&(a=a.data),a.isGLBufferAttribute){let h=e.get(a);(!h||h.version<a.version)&&e.set(a,{buffer:a.buffer,type:a.type,bytesPerElement:a.elementSize,version:a.version});return}let c=e.get(a);if(c===void 0)e.set(a,t(a,l));else if(c.version<a.version){if(c.size!==a.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");n(c.buffer,a,l),c.version=a.version}}return{get:s,remove:r,update:o}}var O_=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,U_=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,k_=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,B_=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,z_=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,V_=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,G_=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,H_=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,W_=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,X_=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,q_=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,Y_=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,$_=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,Z_=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,K_=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,J_=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,j_=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,Q_=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,eb=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,tb=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,nb=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,ib=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,sb=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,rb=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,ob=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,ab=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,lb=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,cb=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,hb=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,ub="gl_FragColor = linearToOutputTexel( gl_FragColor );",db=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,fb=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,pb=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,mb=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,gb=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,vb=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,xb=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,yb=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,_b=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,bb=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,Sb=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,Mb=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,wb=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,Tb=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,Eb=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,Ab=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,Cb=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,Rb=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,Pb=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,Lb=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,Ib=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,Nb=`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,Db=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,Fb=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,Ob=`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,Ub=`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,kb=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,Bb=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,zb=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,Vb=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,Gb=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,Hb=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,Wb=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,Xb=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,qb=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,Yb=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,$b=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,Zb=`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,Kb=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,Jb=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,jb=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,Qb=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,eS=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,tS=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,nS=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,iS=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,sS=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,rS=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,oS=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,aS=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,lS=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,cS=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,hS=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,uS=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,dS=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,fS=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,pS=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,mS=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,gS=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,vS=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,xS=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,yS=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,_S=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,bS=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,SS=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,MS=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,wS=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,TS=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,ES=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,AS=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,CS=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,RS=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,PS=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,LS=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,IS=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,NS=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,DS=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,FS=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,OS=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,US=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,kS=`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,BS=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,zS=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,VS=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,GS=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,HS=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,WS=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,XS=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,qS=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,YS=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,$S=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,ZS=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,KS=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,JS=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,jS=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,QS=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,eM=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,tM=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,nM=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,iM=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,sM=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,rM=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,oM=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,aM=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,lM=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,cM=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,hM=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,uM=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,dM=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,fM=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,pM=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,ft={alphahash_fragment:O_,alphahash_pars_fragment:U_,alphamap_fragment:k_,alphamap_pars_fragment:B_,alphatest_fragment:z_,alphatest_pars_fragment:V_,aomap_fragment:G_,aomap_pars_fragment:H_,batching_pars_vertex:W_,batching_vertex:X_,begin_vertex:q_,beginnormal_vertex:Y_,bsdfs:$_,iridescence_fragment:Z_,bumpmap_pars_fragment:K_,clipping_planes_fragment:J_,clipping_planes_pars_fragment:j_,clipping_planes_pars_vertex:Q_,clipping_planes_vertex:eb,color_fragment:tb,color_pars_fragment:nb,color_pars_vertex:ib,color_vertex:sb,common:rb,defaultnormal_vertex:ob,displacementmap_pars_vertex:ab,displacementmap_vertex:lb,emissivemap_fragment:cb,emissivemap_pars_fragment:hb,colorspace_fragment:ub,colorspace_pars_fragment:db,envmap_fragment:fb,envmap_common_pars_fragment:pb,envmap_pars_fragment:mb,envmap_pars_vertex:gb,envmap_physical_pars_fragment:Ab,envmap_vertex:vb,fog_vertex:xb,fog_pars_vertex:yb,fog_fragment:_b,fog_pars_fragment:bb,gradientmap_pars_fragment:Sb,lightmap_pars_fragment:Mb,lights_lambert_fragment:wb,lights_lambert_pars_fragment:Tb,lights_pars_begin:Eb,lights_toon_fragment:Cb,lights_toon_pars_fragment:Rb,lights_phong_fragment:Pb,lights_phong_pars_fragment:Lb,lights_physical_fragment:Ib,lights_physical_pars_fragment:Nb,lights_fragment_begin:Db,lights_fragment_maps:Fb,lights_fragment_end:Ob,lightprobes_pars_fragment:Ub,logdepthbuf_fragment:kb,logdepthbuf_pars_fragment:Bb,logdepthbuf_pars_vertex:zb,logdepthbuf_vertex:Vb,map_fragment:Gb,map_pars_fragment:Hb,map_particle_fragment:Wb,map_particle_pars_fragment:Xb,metalnessmap_fragment:qb,metalnessmap_pars_fragment:Yb,morphinstance_vertex:$b,morphcolor_vertex:Zb,morphnormal_vertex:Kb,morphtarget_pars_vertex:Jb,morphtarget_vertex:jb,normal_fragment_begin:Qb,normal_fragment_maps:eS,normal_pars_fragment:tS,normal_pars_vertex:nS,normal_vertex:iS,normalmap_pars_fragment:sS,clearcoat_normal_fragment_begin:rS,clearcoat_normal_fragment_maps:oS,clearcoat_pars_fragment:aS,iridescence_pars_fragment:lS,opaque_fragment:cS,packing:hS,premultiplied_alpha_fragment:uS,project_vertex:dS,dithering_fragment:fS,dithering_pars_fragment:pS,roughnessmap_fragment:mS,roughnessmap_pars_fragment:gS,shadowmap_pars_fragment:vS,shadowmap_pars_vertex:xS,shadowmap_vertex:yS,shadowmask_pars_fragment:_S,skinbase_vertex:bS,skinning_pars_vertex:SS,skinning_vertex:MS,skinnormal_vertex:wS,specularmap_fragment:TS,specularmap_pars_fragment:ES,tonemapping_fragment:AS,tonemapping_pars_fragment:CS,transmission_fragment:RS,transmission_pars_fragment:PS,uv_pars_fragment:LS,uv_pars_vertex:IS,uv_vertex:NS,worldpos_vertex:DS,background_vert:FS,background_frag:OS,backgroundCube_vert:US,backgroundCube_frag:kS,cube_vert:BS,cube_frag:zS,depth_vert:VS,depth_frag:GS,distance_vert:HS,distance_frag:WS,equirect_vert:XS,equirect_frag:qS,linedashed_vert:YS,linedashed_frag:$S,meshbasic_vert:ZS,meshbasic_frag:KS,meshlambert_vert:JS,meshlambert_frag:jS,meshmatcap_vert:QS,meshmatcap_frag:eM,meshnormal_vert:tM,meshnormal_frag:nM,meshphong_vert:iM,meshphong_frag:sM,meshphysical_vert:rM,meshphysical_frag:oM,meshtoon_vert:aM,meshtoon_frag:lM,points_vert:cM,points_frag:hM,shadow_vert:uM,shadow_frag:dM,sprite_vert:fM,sprite_frag:pM},Ie={common:{diffuse:{value:new qe(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new it},alphaMap:{value:null},alphaMapTransform:{value:new it},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new it}},envmap:{envMap:{value:null},envMapRotation:{value:new it},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new it}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new it}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new it},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new it},normalScale:{value:new He(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new it},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new it}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new it}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new it}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new qe(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new qe(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new it},alphaTest:{value:0},uvTransform:{value:new it}},sprite:{diffuse:{value:new qe(16777215)},opacity:{value:1},center:{value:new He(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new it},alphaMap:{value:null},alphaMapTransform:{value:new it},alphaTest:{value:0}}},us={basic:{uniforms:Gn([Ie.common,Ie.specularmap,Ie.envmap,Ie.aomap,Ie.lightmap,Ie.fog]),vertexShader:ft.meshbasic_vert,fragmentShader:ft.meshbasic_frag},lambert:{uniforms:Gn([Ie.common,Ie.specularmap,Ie.envmap,Ie.aomap,Ie.lightmap,Ie.emissivemap,Ie.bumpmap,Ie.normalmap,Ie.displacementmap,Ie.fog,Ie.lights,{emissive:{value:new qe(0)},envMapIntensity:{value:1}}]),vertexShader:ft.meshlambert_vert,fragmentShader:ft.meshlambert_frag},phong:{uniforms:Gn([Ie.common,Ie.specularmap,Ie.envmap,Ie.aomap,Ie.lightmap,Ie.emissivemap,Ie.bumpmap,Ie.normalmap,Ie.displacementmap,Ie.fog,Ie.lights,{emissive:{value:new qe(0)},specular:{value:new qe(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:ft.meshphong_vert,fragmentShader:ft.meshphong_frag},standard:{uniforms:Gn([Ie.common,Ie.envmap,Ie.aomap,Ie.lightmap,Ie.emissivemap,Ie.bumpmap,Ie.normalmap,Ie.displacementmap,Ie.roughnessmap,Ie.metalnessmap,Ie.fog,Ie.lights,{emissive:{value:new qe(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:ft.meshphysical_vert,fragmentShader:ft.meshphysical_frag},toon:{uniforms:Gn([Ie.common,Ie.aomap,Ie.lightmap,Ie.emissivemap,Ie.bumpmap,Ie.normalmap,Ie.displacementmap,Ie.gradientmap,Ie.fog,Ie.lights,{emissive:{value:new qe(0)}}]),vertexShader:ft.meshtoon_vert,fragmentShader:ft.meshtoon_frag},matcap:{uniforms:Gn([Ie.common,Ie.bumpmap,Ie.normalmap,Ie.displacementmap,Ie.fog,{matcap:{value:null}}]),vertexShader:ft.meshmatcap_vert,fragmentShader:ft.meshmatcap_frag},points:{uniforms:Gn([Ie.points,Ie.fog]),vertexShader:ft.points_vert,fragmentShader:ft.points_frag},dashed:{uniforms:Gn([Ie.common,Ie.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:ft.linedashed_vert,fragmentShader:ft.linedashed_frag},depth:{uniforms:Gn([Ie.common,Ie.displacementmap]),vertexShader:ft.depth_vert,fragmentShader:ft.depth_frag},normal:{uniforms:Gn([Ie.common,Ie.bumpmap,Ie.normalmap,Ie.displacementmap,{opacity:{value:1}}]),vertexShader:ft.meshnormal_vert,fragmentShader:ft.meshnormal_frag},sprite:{uniforms:Gn([Ie.sprite,Ie.fog]),vertexShader:ft.sprite_vert,fragmentShader:ft.sprite_frag},background:{uniforms:{uvTransform:{value:new it},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:ft.background_vert,fragmentShader:ft.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new it}},vertexShader:ft.backgroundCube_vert,fragmentShader:ft.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:ft.cube_vert,fragmentShader:ft.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:ft.equirect_vert,fragmentShader:ft.equirect_frag},distance:{uniforms:Gn([Ie.common,Ie.displacementmap,{referencePosition:{value:new U},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:ft.distance_vert,fragmentShader:ft.distance_frag},shadow:{uniforms:Gn([Ie.lights,Ie.fog,{color:{value:new qe(0)},opacity:{value:1}}]),vertexShader:ft.shadow_vert,fragmentShader:ft.shadow_frag}};us.physical={uniforms:Gn([us.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new it},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new it},clearcoatNormalScale:{value:new He(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new it},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new it},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new it},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new it},sheen:{value:0},sheenColor:{value:new qe(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new it},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new it},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new it},transmissionSamplerSize:{value:new He},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new it},attenuationDistance:{value:0},attenuationColor:{value:new qe(0)},specularColor:{value:new qe(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new it},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new it},anisotropyVector:{value:new He},anisotropyMap:{value:null},anisotropyMapTransform:{value:new it}}]),vertexShader:ft.meshphysical_vert,fragmentShader:ft.meshphysical_frag};var ch={r:0,b:0,g:0},mM=new dt,Zg=new it;Zg.set(-1,0,0,0,1,0,0,0,1);function gM(i,e,t,n,s,r){let o=new qe(0),a=s===!0?0:1,l,c,h=null,u=0,d=null;function f(y){let A=y.isScene===!0?y.background:null;if(A&&A.isTexture){let S=y.backgroundBlurriness>0;A=e.get(A,S)}return A}function m(y){let A=!1,S=f(y);S===null?g(o,a):S&&S.isColor&&(g(S,1),A=!0);let P=i.xr.getEnvironmentBlendMode();P==="additive"?t.buffers.color.setClear(0,0,0,1,r):P==="alpha-blend"&&t.buffers.color.setClear(0,0,0,0,r),(i.autoClear||A)&&(t.buffers.depth.setTest(!0),t.buffers.depth.setMask(!0),t.buffers.color.setMask(!0),i.clear(i.autoClearColor,i.autoClearDepth,i.autoClearStencil))}function _(y,A){let S=f(A);S&&S.isCubeTexture?(c===void 0&&(c=new ct(new ti(1,1,1),new as({name:"BackgroundCubeMaterial",uniforms:wr(us.backgroundCube.uniforms),vertexShader:us.backgroundCube.vertexShader,fragmentShader:us.backgroundCube.fragmentShader,side:Un,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute("normal"),c.geometry.deleteAttribute("uv"),c.onBeforeRender=function(P,E,x){this.matrixWorld.copyPosition(x.matrixWorld)},Object.defineProperty(c.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),n.update(c)),c.material.uniforms.envMap.value=S,c.material.uniforms.backgroundBlurriness.value=A.backgroundBlurriness,c.material.uniforms.backgroundIntensity.value=A.backgroundIntensity,c.material.uniforms.backgroundRotation.value.setFromMatrix4(mM.makeRotationFromEuler(A.backgroundRotation)).transpose(),S.isRenderTargetTexture===!1&&c.material.uniforms.backgroundRotation.value.premultiply(Zg),c.material.toneMapped=yt.getTransfer(S.colorSpace)!==It,(h!==S||u!==S.version||d!==i.toneMapping)&&(c.material.needsUpdate=!0,h=S,u=S.version,d=i.toneMapping),c.layers.enableAll(),y.unshift(c,c.geometry,c.material,0,0,null)):S&&S.isTexture&&(l===void 0&&(l=new ct(new xr(2,2),new as({name:"BackgroundMaterial",uniforms:wr(us.background.uniforms),vertexShader:us.background.vertexShader,fragmentShader:us.background.fragmentShader,side:ls,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute("normal"),Object.defineProperty(l.material,"map",{get:function(){return this.uniforms.t2D.value}}),n.update(l)),l.material.uniforms.t2D.value=S,l.material.uniforms.backgroundIntensity.value=A.backgroundIntensity,l.material.toneMapped=yt.getTransfer(S.colorSpace)!==It,S.matrixAutoUpdate===!0&&S.updateMatrix(),l.material.uniforms.uvTransform.value.copy(S.matrix),(h!==S||u!==S.version||d!==i.toneMapping)&&(l.material.needsUpdate=!0,h=S,u=S.version,d=i.toneMapping),l.layers.enableAll(),y.unshift(l,l.geometry,l.material,0,0,null))}function g(y,A){y.getRGB(ch,ff(i)),t.buffers.color.setClear(ch.r,ch.g,ch.b,A,r)}function p(){c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0),l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0)}return{getClearColor:function(){return o},setClearColor:function(y,A=1){o.set(y),a=A,g(o,a)},getClearAlpha:function(){return a},setClearAlpha:function(y){a=y,g(o,a)},render:m,addToRenderList:_,dispose:p}}function vM(i,e){let t=i.getParameter(i.MAX_VERTEX_ATTRIBS),n={},s=d(null),r=s,o=!1;function a(N,z,H,I,W){let $=!1,G=u(N,I,H,z);r!==G&&(r=G,c(r.object)),$=f(N,I,H,W),$&&m(N,I,H,W),W!==null&&e.update(W,i.ELEMENT_ARRAY_BUFFER),($||o)&&(o=!1,S(N,z,H,I),W!==null&&i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,e.get(W).buffer))}function l(){return i.createVertexArray()}function c(N){return i.bindVertexArray(N)}function h(N){return i.deleteVertexArray(N)}function u(N,z,H,I){let W=I.wireframe===!0,$=n[z.id];$===void 0&&($={},n[z.id]=$);let G=N.isInstancedMesh===!0?N.id:0,ce=$[G];ce===void 0&&(ce={},$[G]=ce);let J=ce[H.id];J===void 0&&(J={},ce[H.id]=J);let Q=J[W];return Q===void 0&&(Q=d(l()),J[W]=Q),Q}function d(N){let z=[],H=[],I=[];for(let W=0;W<t;W++)z[W]=0,H[W]=0,I[W]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:z,enabledAttributes:H,attributeDivisors:I,object:N,attributes:{},index:null}}function f(N,z,H,I){let W=r.attributes,$=z.attributes,G=0,ce=H.getAttributes();for(let J in ce)if(ce[J].location>=0){let se=W[J],de=$[J];if(de===void 0&&(J==="instanceMatrix"&&N.instanceMatrix&&(de=N.instanceMatrix),J==="instanceColor"&&N.instanceColor&&(de=N.instanceColor)),se===void 0||se.attribute!==de||de&&se.data!==de.data)return!0;G++}return r.attributesNum!==G||r.index!==I}function m(N,z,H,I){let W={},$=z.attributes,G=0,ce=H.getAttributes();for(let J in ce)if(ce[J].location>=0){let se=$[J];se===void 0&&(J==="instanceMatrix"&&N.instanceMatrix&&(se=N.instanceMatrix),J==="instanceColor"&&N.instanceColor&&(se=N.instanceColor));let de={};de.attribute=se,se&&se.data&&(de.data=se.data),W[J]=de,G++}r.attributes=W,r.attributesNum=G,r.index=I}function _(){let N=r.newAttributes;for(let z=0,H=N.length;z<H;z++)N[z]=0}function g(N){p(N,0)}function p(N,z){let H=r.newAttributes,I=r.enabledAttributes,W=r.attributeDivisors;H[N]=1,I[N]===0&&(i.enableVertexAttribArray(N),I[N]=1),W[N]!==z&&(i.vertexAttribDivisor(N,z),W[N]=z)}function y(){let N=r.newAttributes,z=r.enabledAttributes;for(let H=0,I=z.length;H<I;H++)z[H]!==N[H]&&(i.disableVertexAttribArray(H),z[H]=0)}function A(N,z,H,I,W,$,G){G===!0?i.vertexAttribIPointer(N,z,H,W,$):i.vertexAttribPointer(N,z,H,I,W,$)}function S(N,z,H,I){_();let W=I.attributes,$=H.getAttributes(),G=z.defaultAttributeValues;for(let ce in $){let J=$[ce];if(J.location>=0){let Q=W[ce];if(Q===void 0&&(ce==="instanceMatrix"&&N.instanceMatrix&&(Q=N.instanceMatrix),ce==="instanceColor"&&N.instanceColor&&(Q=N.instanceColor)),Q!==void 0){let se=Q.normalized,de=Q.itemSize,ue=e.get(Q);if(ue===void 0)continue;let ee=ue.buffer,me=ue.type,xe=ue.bytesPerElement,Ae=me===i.INT||me===i.UNSIGNED_INT||Q.gpuType===Tc;if(Q.isInterleavedBufferAttribute){let Se=Q.data,We=Se.isInterleavedBuffer===!0?Se.stride:Se.itemSize,ot=Q.offset;if(Se.isInstancedInterleavedBuffer||Se.isInstancedBufferAttribute){for(let Ve=0;Ve<J.locationSize;Ve++)p(J.location+Ve,Se.meshPerAttribute);N.isInstancedMesh!==!0&&I._maxInstanceCount===void 0&&(I._maxInstanceCount=Se.meshPerAttribute*Se.count)}else for(let Ve=0;Ve<J.locationSize;Ve++)g(J.location+Ve);i.bindBuffer(i.ARRAY_BUFFER,ee);for(let Ve=0;Ve<J.locationSize;Ve++)A(J.location+Ve,de/J.locationSize,me,se,We*xe,(ot+de/J.locationSize*Ve)*xe,Ae)}else{if(Q.isInstancedBufferAttribute){for(let Se=0;Se<J.locationSize;Se++)p(J.location+Se,Q.meshPerAttribute);N.isInstancedMesh!==!0&&I._maxInstanceCount===void 0&&(I._maxInstanceCount=Q.meshPerAttribute*Q.count)}else for(let Se=0;Se<J.locationSize;Se++)g(J.location+Se);i.bindBuffer(i.ARRAY_BUFFER,ee);for(let Se=0;Se<J.locationSize;Se++)A(J.location+Se,de/J.locationSize,me,se,de*xe,de/J.locationSize*Se*xe,Ae)}}else if(G!==void 0){let se=G[ce];if(se!==void 0)switch(se.length){case 2:i.vertexAttrib2fv(J.location,se);break;case 3:i.vertexAttrib3fv(J.location,se);break;case 4:i.vertexAttrib4fv(J.location,se);break;default:i.vertexAttrib1fv(J.location,se)}}}}y()}function P(){k();for(let N in n){let z=n[N];for(let H in z){let I=z[H];for(let W in I){let $=I[W];for(let G in $)h($[G].object),delete $[G];delete I[W]}}delete n[N]}}function E(N){if(n[N.id]===void 0)return;let z=n[N.id];for(let H in z){let I=z[H];for(let W in I){let $=I[W];for(let G in $)h($[G].object),delete $[G];delete I[W]}}delete n[N.id]}function x(N){for(let z in n){let H=n[z];for(let I in H){let W=H[I];if(W[N.id]===void 0)continue;let $=W[N.id];for(let G in $)h($[G].object),delete $[G];delete W[N.id]}}}function T(N){for(let z in n){let H=n[z],I=N.isInstancedMesh===!0?N.id:0,W=H[I];if(W!==void 0){for(let $ in W){let G=W[$];for(let ce in G)h(G[ce].object),delete G[ce];delete W[$]}delete H[I],Object.keys(H).length===0&&delete n[z]}}}function k(){D(),o=!0,r!==s&&(r=s,c(r.object))}function D(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:a,reset:k,resetDefaultState:D,dispose:P,releaseStatesOfGeometry:E,releaseStatesOfObject:T,releaseStatesOfProgram:x,initAttributes:_,enableAttribute:g,disableUnusedAttributes:y}}function xM(i,e,t){let n;function s(l){n=l}function r(l,c){i.drawArrays(n,l,c),t.update(c,n,1)}function o(l,c,h){h!==0&&(i.drawArraysInstanced(n,l,c,h),t.update(c,n,h))}function a(l,c,h){if(h===0)return;e.get("WEBGL_multi_draw").multiDrawArraysWEBGL(n,l,0,c,0,h);let d=0;for(let f=0;f<h;f++)d+=c[f];t.update(d,n,1)}this.setMode=s,this.render=r,this.renderInstances=o,this.renderMultiDraw=a}function yM(i,e,t,n){let s;function r(){if(s!==void 0)return s;if(e.has("EXT_texture_filter_anisotropic")===!0){let x=e.get("EXT_texture_filter_anisotropic");s=i.getParameter(x.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function o(x){return!(x!==Vi&&n.convert(x)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_FORMAT))}function a(x){let T=x===zi&&(e.has("EXT_color_buffer_half_float")||e.has("EXT_color_buffer_float"));return!(x!==ni&&x!==Ci&&!T&&n.convert(x)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_TYPE))}function l(x){if(x==="highp"){if(i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.HIGH_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.HIGH_FLOAT).precision>0)return"highp";x="mediump"}return x==="mediump"&&i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.MEDIUM_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=t.precision!==void 0?t.precision:"highp",h=l(c);h!==c&&($e("WebGLRenderer:",c,"not supported, using",h,"instead."),c=h);let u=t.reversedDepthBuffer===!0&&e.has("EXT_clip_control"),d=t.logarithmicDepthBuffer===!0&&u===!1;t.reversedDepthBuffer===!0&&u===!1&&$e("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),t.logarithmicDepthBuffer===!0&&u===!0&&$e("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");let f=i.getParameter(i.MAX_TEXTURE_IMAGE_UNITS),m=i.getParameter(i.MAX_VERTEX_TEXTURE_IMAGE_UNITS),_=i.getParameter(i.MAX_TEXTURE_SIZE),g=i.getParameter(i.MAX_CUBE_MAP_TEXTURE_SIZE),p=i.getParameter(i.MAX_VERTEX_ATTRIBS),y=i.getParameter(i.MAX_VERTEX_UNIFORM_VECTORS),A=i.getParameter(i.MAX_VARYING_VECTORS),S=i.getParameter(i.MAX_FRAGMENT_UNIFORM_VECTORS),P=i.getParameter(i.MAX_SAMPLES),E=i.getParameter(i.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:l,textureFormatReadable:o,textureTypeReadable:a,precision:c,logarithmicDepthBuffer:d,reversedDepthBuffer:u,maxTextures:f,maxVertexTextures:m,maxTextureSize:_,maxCubemapSize:g,maxAttributes:p,maxVertexUniforms:y,maxVaryings:A,maxFragmentUniforms:S,maxSamples:P,samples:E}}function _M(i){let e=this,t=null,n=0,s=!1,r=!1,o=new di,a=new it,l={value:null,needsUpdate:!1};this.uniform=l,this.numPlanes=0,this.numIntersection=0,this.init=function(u,d){let f=u.length!==0||d||n!==0||s;return s=d,n=u.length,f},this.beginShadows=function(){r=!0,h(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(u,d){t=h(u,d,0)},this.setState=function(u,d,f){let m=u.clippingPlanes,_=u.clipIntersection,g=u.clipShadows,p=i.get(u);if(!s||m===null||m.length===0||r&&!g)r?h(null):c();else{let y=r?0:n,A=y*4,S=p.clippingState||null;l.value=S,S=h(m,d,A,f);for(let P=0;P!==A;++P)S[P]=t[P];p.clippingState=S,this.numIntersection=_?this.numPlanes:0,this.numPlanes+=y}};function c(){l.value!==t&&(l.value=t,l.needsUpdate=n>0),e.numPlanes=n,e.numIntersection=0}function h(u,d,f,m){let _=u!==null?u.length:0,g=null;if(_!==0){if(g=l.value,m!==!0||g===null){let p=f+_*4,y=d.matrixWorldInverse;a.getNormalMatrix(y),(g===null||g.length<p)&&(g=new Float32Array(p));for(let A=0,S=f;A!==_;++A,S+=4)o.copy(u[A]).applyMatrix4(y,a),o.normal.toArray(g,S),g[S+3]=o.constant}l.value=g,l.needsUpdate=!0}return e.numPlanes=_,e.numIntersection=0,g}}var Ba=class extends fi{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let n={width:e,height:e,depth:1},s=[n,n,n,n,n,n];this.texture=new ga(s),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new ti(5,5,5),r=new as({name:"CubemapFromEquirect",uniforms:wr(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:Un,blending:_r});r.uniforms.tEquirect.value=t;let o=new ct(s,r),a=t.minFilter;return t.minFilter===Ps&&(t.minFilter=Kn),new po(1,10,this).update(e,o),t.minFilter=a,o.geometry.dispose(),o.material.dispose(),this}clear(e,t=!0,n=!0,s=!0){let r=e.getRenderTarget();for(let o=0;o<6;o++)e.setRenderTarget(this,o),e.clear(t,n,s);e.setRenderTarget(r)}},Ag=256,bM=3,SM=20,Kg=256,Jg=16,MM=3,wM=new U,TM=new qe,uh=class i{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new po(1,10,null),this._boxMesh=new ct(new ti(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,n=.1,s=100,r={}){let{size:o=256,position:a=wM}=r,l=this._renderer;this._setSize(o);let c=this._allocateTarget(),h=this._getSourceTarget(!0);t>0&&(h.texture.mipmapsAutoUpdate=!1);let u=l.autoClear,d=l.autoClearColor,f=l.autoClearDepth,m=l.autoClearStencil,_=e.background;l.autoClear=!0,l.autoClearColor=!0,l.autoClearDepth=!0,l.autoClearStencil=!0,_===null&&(e.background=l.getClearColor(TM));let g=new po(n,s,h);return g.position.copy(a),g.update(l,e),l.autoClear=u,l.autoClearColor=d,l.autoClearDepth=f,l.autoClearStencil=m,e.background=_,t>0&&(h.texture.mipmapsAutoUpdate=!0,this._blur(c,t)),this._applyPMREM(c),c}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=Pg(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=Rg(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(Ag,uf(e))}_fromTexture(e,t){e.mapping===Sr||e.mapping===xo?this._setSize(e.image.length===0?Ag:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let n=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(n),n}_allocateTarget(){let e=this._cubeSize,t=Cg(e,!1,!1),n=Math.log2(e)-bM;for(let s=0;s<=n;s++)t.texture.mipmaps.push({width:e>>s,height:e>>s});return t.texture.name="PMREM",t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==t||e&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=Cg(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,n){let s=this._boxMesh,r=this._cubeCamera;s.material=n,r.renderTarget=e,r.activeMipmapLevel=t;let o=e.width>>t;e.viewport.set(0,0,o,o),r.update(this._renderer,s),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===Sr||e.mapping===xo?(this._cubemapMaterial===null&&(this._cubemapMaterial=Pg()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=Rg()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(e){this._ggxMaterial===null&&(this._ggxMaterial=EM(),this._integrationMaterial=AM());let t=this._cubeSize,n=e.texture.mipmaps.length-1,s=this._ggxMaterial.uniforms;s.envMap.value=this._sourceTarget.texture;let r=this._integrationMaterial.uniforms;r.envMap.value=this._sourceTarget.texture,r.sourceLod.value=Math.log2(t/Jg);for(let o=0;o<=n;o++){let a=i.lodToRoughness(o,n);if(o>n-MM)r.roughness.value=a,this._renderCube(e,o,this._integrationMaterial);else{let l=a>0?Math.log2(t)+.5*Math.log2(6/(Kg*Math.pow(a,4)))+.5:0;s.roughness.value=a,s.lodBias.value=l,this._renderCube(e,o,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=CM());let n=this._blurMaterial,s=n.uniforms,r=this._sourceTarget;s.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,s.envMap.value=r.texture,this._renderCube(e,0,n),s.envMap.value=e.texture,this._renderCube(r,0,n)}};function Cg(i,e,t){return new Ba(i,{minFilter:Ps,generateMipmaps:e,type:zi,colorSpace:mr,depthBuffer:t})}function za(i,e,t){return new as({name:i,uniforms:e,vertexShader:ft.cube_vert,fragmentShader:t,side:Un,blending:_r,depthTest:!1,depthWrite:!1})}function EM(){return za("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${Kg}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function AM(){return za("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:Jg}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function CM(){return za("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${SM}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function Rg(){return za("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function Pg(){return za("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function RM(i){let e=new WeakMap,t=new WeakMap,n=null;function s(d,f=!1){return d==null?null:f?o(d):r(d)}function r(d){if(d&&d.isTexture){let f=d.mapping;if(f===Sc||f===Mc)if(e.has(d)){let m=e.get(d).texture;return a(m,d.mapping)}else{let m=d.image;if(m&&m.height>0){let _=new Ba(m.height);return _.fromEquirectangularTexture(i,d),e.set(d,_),d.addEventListener("dispose",c),a(_.texture,d.mapping)}else return null}}return d}function o(d){if(d&&d.isTexture&&d.isPMREMTexture!==!0){let f=d.mapping,m=f===Sc||f===Mc,_=f===Sr||f===xo;if(m||_){let g=t.get(d),p=g!==void 0?g.texture.pmremVersion:0;if(d.isRenderTargetTexture&&d.pmremVersion!==p)return n===null&&(n=new uh(i)),g=m?n.fromEquirectangular(d,g):n.fromCubemap(d,g),g.texture.pmremVersion=d.pmremVersion,t.set(d,g),g.texture;if(g!==void 0)return g.texture;{let y=d.image;return m&&y&&y.height>0||_&&y&&l(y)?(n===null&&(n=new uh(i)),g=m?n.fromEquirectangular(d):n.fromCubemap(d),g.texture.pmremVersion=d.pmremVersion,t.set(d,g),d.addEventListener("dispose",h),g.texture):null}}}return d}function a(d,f){return f===Sc?d.mapping=Sr:f===Mc&&(d.mapping=xo),d}function l(d){let f=0,m=6;for(let _=0;_<m;_++)d[_]!==void 0&&f++;return f===m}function c(d){let f=d.target;f.removeEventListener("dispose",c);let m=e.get(f);m!==void 0&&(e.delete(f),m.dispose())}function h(d){let f=d.target;f.removeEventListener("dispose",h);let m=t.get(f);m!==void 0&&(t.delete(f),m.dispose())}function u(){e=new WeakMap,t=new WeakMap,n!==null&&(n.dispose(),n=null)}return{get:s,dispose:u}}function PM(i){let e={};function t(n){if(e[n]!==void 0)return e[n];let s=i.getExtension(n);return e[n]=s,s}return{has:function(n){return t(n)!==null},init:function(){t("EXT_color_buffer_float"),t("WEBGL_clip_cull_distance"),t("OES_texture_float_linear"),t("EXT_color_buffer_half_float"),t("WEBGL_multisampled_render_to_texture"),t("WEBGL_render_shared_exponent")},get:function(n){let s=t(n);return s===null&&ia("WebGLRenderer: "+n+" extension not supported."),s}}}function LM(i,e,t,n){let s={},r=new WeakMap,o=new FinalizationRegistry(m=>delete s[m]);function a(m){l(m.target)}function l(m){m.index!==null&&e.remove(m.index);for(let g in m.attributes)e.remove(m.attributes[g]);m.removeEventListener("dispose",a),delete s[m.id],o.unregister(m);let _=r.get(m);_&&(e.remove(_),r.delete(m)),n.releaseStatesOfGeometry(m),m.isInstancedBufferGeometry===!0&&delete m._maxInstanceCount,t.memory.geometries--}function c(m,_){return s[_.id]!==void 0||(_.addEventListener("dispose",a),s[_.id]=new WeakRef(_),o.register(_,_.id,_),t.memory.geometries++),_}function h(m){let _=m.attributes;for(let g in _)e.update(_[g],i.ARRAY_BUFFER)}function u(m){let _=m.index,g=m.attributes.position,p=0;if(g===void 0)return;let y=_!==null?_.array.length:g.array.length/3-1,A=g.count>=65535?fa:da,S=new A(Math.ceil(y/3)*6,1),P=S.array;if(_!==null){let x=_.array;p=_.version;for(let T=0,k=0;T<y;T+=3){let D=x[T+0],N=x[T+1],z=x[T+2];P[k++]=D,P[k++]=N,P[k++]=N,P[k++]=z,P[k++]=z,P[k++]=D}}else{p=g.version;for(let x=0,T=0;x<y;x+=3){let k=x+0,D=x+1,N=x+2;P[T++]=k,P[T++]=D,P[T++]=D,P[T++]=N,P[T++]=N,P[T++]=k}}S.version=p;let E=r.get(m);E&&e.remove(E),r.set(m,S)}function d(m){let _=r.get(m);if(_){let g=m.index;g!==null&&_.version<g.version&&u(m)}else u(m);return r.get(m)}function f(){for(let m in s){let _=s[m].deref();_!==void 0&&l(_)}}return{get:c,update:h,getWireframeAttribute:d,dispose:f}}function IM(i,e,t){let n;function s(u){n=u}let r,o;function a(u){r=u.type,o=u.bytesPerElement}function l(u,d){i.drawElements(n,d,r,u*o),t.update(d,n,1)}function c(u,d,f){f!==0&&(i.drawElementsInstanced(n,d,r,u*o,f),t.update(d,n,f))}function h(u,d,f){if(f===0)return;e.get("WEBGL_multi_draw").multiDrawElementsWEBGL(n,d,0,r,u,0,f);let _=0;for(let g=0;g<f;g++)_+=d[g];t.update(_,n,1)}this.setMode=s,this.setIndex=a,this.render=l,this.renderInstances=c,this.renderMultiDraw=h}function NM(i){let e={geometries:0,textures:0},t={frame:0,calls:0,triangles:0,points:0,lines:0};function n(r,o,a){switch(t.calls++,o){case i.TRIANGLES:t.triangles+=a*(r/3);break;case i.LINES:t.lines+=a*(r/2);break;case i.LINE_STRIP:t.lines+=a*(r-1);break;case i.LINE_LOOP:t.lines+=a*r;break;case i.POINTS:t.points+=a*r;break;default:nt("WebGLInfo: Unknown draw mode:",o);break}}function s(){t.calls=0,t.triangles=0,t.points=0,t.lines=0}return{memory:e,render:t,programs:null,autoReset:!0,reset:s,update:n}}function DM(i,e,t){let n=new WeakMap,s=new en;function r(o,a,l){let c=o.morphTargetInfluences,h=a.morphAttributes.position||a.morphAttributes.normal||a.morphAttributes.color,u=h!==void 0?h.length:0,d=n.get(a);if(d===void 0||d.count!==u){let k=function(){x.dispose(),n.delete(a),a.removeEventListener("dispose",k)};d!==void 0&&d.texture.dispose();let f=a.morphAttributes.position!==void 0,m=a.morphAttributes.normal!==void 0,_=a.morphAttributes.color!==void 0,g=a.morphAttributes.position||[],p=a.morphAttributes.normal||[],y=a.morphAttributes.color||[],A=0;f===!0&&(A=1),m===!0&&(A=2),_===!0&&(A=3);let S=a.attributes.position.count*A,P=1;S>e.maxTextureSize&&(P=Math.ceil(S/e.maxTextureSize),S=e.maxTextureSize);let E=new Float32Array(S*P*4*u),x=new la(E,S,P,u);x.type=Ci,x.needsUpdate=!0;let T=A*4;for(let D=0;D<u;D++){let N=g[D],z=p[D],H=y[D],I=S*P*4*D;for(let W=0;W<N.count;W++){let $=W*T;f===!0&&(s.fromBufferAttribute(N,W),E[I+$+0]=s.x,E[I+$+1]=s.y,E[I+$+2]=s.z,E[I+$+3]=0),m===!0&&(s.fromBufferAttribute(z,W),E[I+$+4]=s.x,E[I+$+5]=s.y,E[I+$+6]=s.z,E[I+$+7]=0),_===!0&&(s.fromBufferAttribute(H,W),E[I+$+8]=s.x,E[I+$+9]=s.y,E[I+$+10]=s.z,E[I+$+11]=H.itemSize===4?s.w:1)}}d={count:u,texture:x,size:new He(S,P)},n.set(a,d),a.addEventListener("dispose",k)}if(o.isInstancedMesh===!0&&o.morphTexture!==null)l.getUniforms().setValue(i,"morphTexture",o.morphTexture,t);else{let f=0;for(let _=0;_<c.length;_++)f+=c[_];let m=a.morphTargetsRelative?1:1-f;l.getUniforms().setValue(i,"morphTargetBaseInfluence",m),l.getUniforms().setValue(i,"morphTargetInfluences",c)}l.getUniforms().setValue(i,"morphTargetsTexture",d.texture,t),l.getUniforms().setValue(i,"morphTargetsTextureSize",d.size)}return{update:r}}function FM(i,e,t,n,s){let r=new WeakMap;function o(c){let h=s.render.frame,u=c.geometry,d=e.get(c,u);if(r.get(d)!==h&&(e.update(d),r.set(d,h)),c.isInstancedMesh&&(c.hasEventListener("dispose",l)===!1&&c.addEventListener("dispose",l),r.get(c)!==h&&(t.update(c.instanceMatrix,i.ARRAY_BUFFER),c.instanceColor!==null&&t.update(c.instanceColor,i.ARRAY_BUFFER),r.set(c,h))),c.isSkinnedMesh){let f=c.skeleton;r.get(f)!==h&&(f.update(),r.set(f,h))}return d}function a(){r=new WeakMap}function l(c){let h=c.target;h.removeEventListener("dispose",l),n.releaseStatesOfObject(h),t.remove(h.instanceMatrix),h.instanceColor!==null&&t.remove(h.instanceColor)}return{update:o,dispose:a}}var OM={[Wd]:"LINEAR_TONE_MAPPING",[Xd]:"REINHARD_TONE_MAPPING",[qd]:"CINEON_TONE_MAPPING",[Yd]:"ACES_FILMIC_TONE_MAPPING",[Zd]:"AGX_TONE_MAPPING",[Kd]:"NEUTRAL_TONE_MAPPING",[$d]:"CUSTOM_TONE_MAPPING"};function UM(i,e,t,n,s,r){let o=new fi(e,t,{type:i,depthBuffer:s,stencilBuffer:r,samples:n?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),a=null,l=null,c=null,h=new zt;h.setAttribute("position",new Mt([-1,3,0,-1,-1,0,3,-1,0],3)),h.setAttribute("uv",new Mt([0,2,0,0,2,0],2));let u=new oc({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),d=new ct(h,u),f=new Ea(-1,1,1,-1,0,1),m=null,_=null,g=!1,p,y=null,A=[],S=!1;this.setSize=function(P,E){o.setSize(P,E),a!==null&&a.setSize(P,E),l!==null&&l.setSize(P,E);for(let x=0;x<A.length;x++){let T=A[x];T.setSize&&T.setSize(P,E)}},this.setEffects=function(P){A=P,S=A.length>0&&A[0].isRenderPass===!0;let E=o.width,x=o.height;A.length>0&&a===null&&(a=new fi(E,x,{type:zi,depthBuffer:!1,stencilBuffer:!1}),l=new fi(E,x,{type:zi,depthBuffer:!1,stencilBuffer:!1}));let T=s===!0&&A.some(k=>k.needsDepthTexture===!0);T!==(o.depthTexture!==null)&&(T===!0&&c===null&&(c=new Cs(E,x),r===!0&&(c.format=Ls,c.type=Mr)),o.dispose(),o.depthTexture=T?c:null,o.resolveDepthBuffer=T,o.storeMultisampledDepthBuffer=T);for(let k=0;k<A.length;k++){let D=A[k];D.setSize&&D.setSize(E,x),T&&D.needsDepthTexture===!0&&D.setDepthTexture&&D.setDepthTexture(c)}},this.begin=function(P,E){if(g||P.toneMapping===cs&&A.length===0)return!1;if(y=E,E!==null){let x=E.width,T=E.height;(o.width!==x||o.height!==T)&&this.setSize(x,T)}return S===!1&&P.setRenderTarget(o),p=P.toneMapping,P.toneMapping=cs,!0},this.hasRenderPass=function(){return S},this.end=function(P,E){P.toneMapping=p,g=!0;let x=o,T=a;for(let k=0;k<A.length;k++){let D=A[k];D.enabled!==!1&&(D.render(P,T,x,E),D.needsSwap!==!1&&(x=T,T=T===a?l:a))}if(m!==P.outputColorSpace||_!==P.toneMapping){m=P.outputColorSpace,_=P.toneMapping,u.defines={},yt.getTransfer(m)===It&&(u.defines.SRGB_TRANSFER="");let k=OM[_];k&&(u.defines[k]=""),u.needsUpdate=!0}u.uniforms.tDiffuse.value=x.texture,P.setRenderTarget(y),P.render(d,f),y=null,g=!1},this.isCompositing=function(){return g},this.dispose=function(){o.dispose(),a!==null&&a.dispose(),l!==null&&l.dispose(),h.dispose(),u.dispose()}}var jg=new ei,Qg=new Cs(1,1),e0=new va(1),t0=new la,n0=new nc,i0=new ga,Lg=[],Ig=[],Ng=new Float32Array(16),Dg=new Float32Array(9),Fg=new Float32Array(4);function So(i,e,t){let n=i[0];if(n<=0||n>0)return i;let s=e*t,r=Lg[s];if(r===void 0&&(r=new Float32Array(s),Lg[s]=r),e!==0){n.toArray(r,0);for(let o=1,a=0;o!==e;++o)a+=t,i[o].toArray(r,a)}return r}function bn(i,e){if(i.length!==e.length)return!1;for(let t=0,n=i.length;t<n;t++)if(i[t]!==e[t])return!1;return!0}function Sn(i,e){for(let t=0,n=e.length;t<n;t++)i[t]=e[t]}function fh(i,e){let t=Ig[e];t===void 0&&(t=new Int32Array(e),Ig[e]=t);for(let n=0;n!==e;++n)t[n]=i.allocateTextureUnit();return t}function kM(i,e){let t=this.cache;t[0]!==e&&(i.uniform1f(this.addr,e),t[0]=e)}function BM(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2f(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(bn(t,e))return;i.uniform2fv(this.addr,e),Sn(t,e)}}function zM(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3f(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else if(e.r!==void 0)(t[0]!==e.r||t[1]!==e.g||t[2]!==e.b)&&(i.uniform3f(this.addr,e.r,e.g,e.b),t[0]=e.r,t[1]=e.g,t[2]=e.b);else{if(bn(t,e))return;i.uniform3fv(this.addr,e),Sn(t,e)}}function VM(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4f(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(bn(t,e))return;i.uniform4fv(this.addr,e),Sn(t,e)}}function GM(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(bn(t,e))return;i.uniformMatrix2fv(this.addr,!1,e),Sn(t,e)}else{if(bn(t,n))return;Fg.set(n),i.uniformMatrix2fv(this.addr,!1,Fg),Sn(t,n)}}function HM(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(bn(t,e))return;i.uniformMatrix3fv(this.addr,!1,e),Sn(t,e)}else{if(bn(t,n))return;Dg.set(n),i.uniformMatrix3fv(this.addr,!1,Dg),Sn(t,n)}}function WM(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(bn(t,e))return;i.uniformMatrix4fv(this.addr,!1,e),Sn(t,e)}else{if(bn(t,n))return;Ng.set(n),i.uniformMatrix4fv(this.addr,!1,Ng),Sn(t,n)}}function XM(i,e){let t=this.cache;t[0]!==e&&(i.uniform1i(this.addr,e),t[0]=e)}function qM(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2i(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(bn(t,e))return;i.uniform2iv(this.addr,e),Sn(t,e)}}function YM(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3i(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(bn(t,e))return;i.uniform3iv(this.addr,e),Sn(t,e)}}function $M(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4i(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(bn(t,e))return;i.uniform4iv(this.addr,e),Sn(t,e)}}function ZM(i,e){let t=this.cache;t[0]!==e&&(i.uniform1ui(this.addr,e),t[0]=e)}function KM(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2ui(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(bn(t,e))return;i.uniform2uiv(this.addr,e),Sn(t,e)}}function JM(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3ui(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(bn(t,e))return;i.uniform3uiv(this.addr,e),Sn(t,e)}}function jM(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4ui(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(bn(t,e))return;i.uniform4uiv(this.addr,e),Sn(t,e)}}function ph(i){return i.version===0&&(i.compareFunction=af,i.needsUpdate=!0),i}function QM(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_2D_SHADOW?r=ph(Qg):r=jg,t.setTexture2D(e||r,s)}function ew(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture3D(e||n0,s)}function tw(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_CUBE_SHADOW?r=ph(e0):r=i0,t.setTextureCube(e||r,s)}function nw(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture2DArray(e||t0,s)}function iw(i){switch(i){case 5126:return kM;case 35664:return BM;case 35665:return zM;case 35666:return VM;case 35674:return GM;case 35675:return HM;case 35676:return WM;case 5124:case 35670:return XM;case 35667:case 35671:return qM;case 35668:case 35672:return YM;case 35669:case 35673:return $M;case 5125:return ZM;case 36294:return KM;case 36295:return JM;case 36296:return jM;case 35678:case 36198:case 36298:case 36306:case 35682:return QM;case 35679:case 36299:case 36307:return ew;case 35680:case 36300:case 36308:case 36293:return tw;case 36289:case 36303:case 36311:case 36292:return nw}}function sw(i,e){i.uniform1fv(this.addr,e)}function rw(i,e){let t=So(e,this.size,2);i.uniform2fv(this.addr,t)}function ow(i,e){let t=So(e,this.size,3);i.uniform3fv(this.addr,t)}function aw(i,e){let t=So(e,this.size,4);i.uniform4fv(this.addr,t)}function lw(i,e){let t=So(e,this.size,4);i.uniformMatrix2fv(this.addr,!1,t)}function cw(i,e){let t=So(e,this.size,9);i.uniformMatrix3fv(this.addr,!1,t)}function hw(i,e){let t=So(e,this.size,16);i.uniformMatrix4fv(this.addr,!1,t)}function uw(i,e){i.uniform1iv(this.addr,e)}function dw(i,e){i.uniform2iv(this.addr,e)}function fw(i,e){i.uniform3iv(this.addr,e)}function pw(i,e){i.uniform4iv(this.addr,e)}function mw(i,e){i.uniform1uiv(this.addr,e)}function gw(i,e){i.uniform2uiv(this.addr,e)}function vw(i,e){i.uniform3uiv(this.addr,e)}function xw(i,e){i.uniform4uiv(this.addr,e)}function yw(i,e,t){let n=this.cache,s=e.length,r=fh(t,s);bn(n,r)||(i.uniform1iv(this.addr,r),Sn(n,r));let o;this.type===i.SAMPLER_2D_SHADOW?o=ph(Qg):o=jg;for(let a=0;a!==s;++a)t.setTexture2D(e[a]||o,r[a])}function _w(i,e,t){let n=this.cache,s=e.length,r=fh(t,s);bn(n,r)||(i.uniform1iv(this.addr,r),Sn(n,r));for(let o=0;o!==s;++o)t.setTexture3D(e[o]||n0,r[o])}function bw(i,e,t){let n=this.cache,s=e.length,r=fh(t,s);bn(n,r)||(i.uniform1iv(this.addr,r),Sn(n,r));let o;this.type===i.SAMPLER_CUBE_SHADOW?o=ph(e0):o=i0;for(let a=0;a!==s;++a)t.setTextureCube(e[a]||o,r[a])}function Sw(i,e,t){let n=this.cache,s=e.length,r=fh(t,s);bn(n,r)||(i.uniform1iv(this.addr,r),Sn(n,r));for(let o=0;o!==s;++o)t.setTexture2DArray(e[o]||t0,r[o])}function Mw(i){switch(i){case 5126:return sw;case 35664:return rw;case 35665:return ow;case 35666:return aw;case 35674:return lw;case 35675:return cw;case 35676:return hw;case 5124:case 35670:return uw;case 35667:case 35671:return dw;case 35668:case 35672:return fw;case 35669:case 35673:return pw;case 5125:return mw;case 36294:return gw;case 36295:return vw;case 36296:return xw;case 35678:case 36198:case 36298:case 36306:case 35682:return yw;case 35679:case 36299:case 36307:return _w;case 35680:case 36300:case 36308:case 36293:return bw;case 36289:case 36303:case 36311:case 36292:return Sw}}var yf=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=iw(t.type)}},_f=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=Mw(t.type)}},bf=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){let s=this.seq;for(let r=0,o=s.length;r!==o;++r){let a=s[r];a.setValue(e,t[a.id],n)}}},vf=/(\w+)(\])?(\[|\.)?/g;function Og(i,e){i.seq.push(e),i.map[e.id]=e}function ww(i,e,t){let n=i.name,s=n.length;for(vf.lastIndex=0;;){let r=vf.exec(n),o=vf.lastIndex,a=r[1],l=r[2]==="]",c=r[3];if(l&&(a=a|0),c===void 0||c==="["&&o+2===s){Og(t,c===void 0?new yf(a,i,e):new _f(a,i,e));break}else{let u=t.map[a];u===void 0&&(u=new bf(a),Og(t,u)),t=u}}}var bo=class{constructor(e,t){this.seq=[],this.map={};let n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let o=0;o<n;++o){let a=e.getActiveUniform(t,o),l=e.getUniformLocation(t,a.name);ww(a,l,this)}let s=[],r=[];for(let o of this.seq)o.type===e.SAMPLER_2D_SHADOW||o.type===e.SAMPLER_CUBE_SHADOW||o.type===e.SAMPLER_2D_ARRAY_SHADOW?s.push(o):r.push(o);s.length>0&&(this.seq=s.concat(r))}setValue(e,t,n,s){let r=this.map[t];r!==void 0&&r.setValue(e,n,s)}setOptional(e,t,n){let s=t[n];s!==void 0&&this.setValue(e,n,s)}static upload(e,t,n,s){for(let r=0,o=t.length;r!==o;++r){let a=t[r],l=n[a.id];l.needsUpdate!==!1&&a.setValue(e,l.value,s)}}static seqWithValue(e,t){let n=[];for(let s=0,r=e.length;s!==r;++s){let o=e[s];o.id in t&&n.push(o)}return n}};function Ug(i,e,t){let n=i.createShader(e);return i.shaderSource(n,t),i.compileShader(n),n}var Tw=37297,Ew=0;function Aw(i,e){let t=i.split(`
`),n=[],s=Math.max(e-6,0),r=Math.min(e+6,t.length);for(let o=s;o<r;o++){let a=o+1;n.push(`${a===e?">":" "} ${a}: ${t[o]}`)}return n.join(`
`)}var kg=new it;function Cw(i){yt._getMatrix(kg,yt.workingColorSpace,i);let e=`mat3( ${kg.elements.map(t=>t.toFixed(4))} )`;switch(yt.getTransfer(i)){case oa:return[e,"LinearTransferOETF"];case It:return[e,"sRGBTransferOETF"];default:return $e("WebGLProgram: Unsupported color space: ",i),[e,"LinearTransferOETF"]}}function Bg(i,e,t){let n=i.getShaderParameter(e,i.COMPILE_STATUS),r=(i.getShaderInfoLog(e)||"").trim();if(n&&r==="")return"";let o=/ERROR: 0:(\d+)/.exec(r);if(o){let a=parseInt(o[1]);return t.toUpperCase()+`

`+r+`

`+Aw(i.getShaderSource(e),a)}else return r}function Rw(i,e){let t=Cw(e);return[`vec4 ${i}( vec4 value ) {`,`	return ${t[1]}( vec4( ${t[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}var Pw={[Wd]:"Linear",[Xd]:"Reinhard",[qd]:"Cineon",[Yd]:"ACESFilmic",[Zd]:"AgX",[Kd]:"Neutral",[$d]:"Custom"};function Lw(i,e){let t=Pw[e];return t===void 0?($e("WebGLProgram: Unsupported toneMapping:",e),"vec3 "+i+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+i+"( vec3 color ) { return "+t+"ToneMapping( color ); }"}var hh=new U;function Iw(){yt.getLuminanceCoefficients(hh);let i=hh.x.toFixed(4),e=hh.y.toFixed(4),t=hh.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${i}, ${e}, ${t} );`,"	return dot( weights, rgb );","}"].join(`
`)}function Nw(i){return[i.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",i.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(ka).join(`
`)}function Dw(i){let e=[];for(let t in i){let n=i[t];n!==!1&&e.push("#define "+t+" "+n)}return e.join(`
`)}function Fw(i,e){let t={},n=i.getProgramParameter(e,i.ACTIVE_ATTRIBUTES);for(let s=0;s<n;s++){let r=i.getActiveAttrib(e,s),o=r.name,a=1;r.type===i.FLOAT_MAT2&&(a=2),r.type===i.FLOAT_MAT3&&(a=3),r.type===i.FLOAT_MAT4&&(a=4),t[o]={type:r.type,location:i.getAttribLocation(e,o),locationSize:a}}return t}function ka(i){return i!==""}function zg(i,e){let t=e.numSpotLightShadows+e.numSpotLightMaps-e.numSpotLightShadowsWithMaps;return i.replace(/NUM_SUN_LIGHTS/g,e.numSunLights).replace(/NUM_DIR_LIGHTS/g,e.numDirLights).replace(/NUM_SPOT_LIGHTS/g,e.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,e.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,t).replace(/NUM_RECT_AREA_LIGHTS/g,e.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,e.numPointLights).replace(/NUM_HEMI_LIGHTS/g,e.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,e.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,e.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,e.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,e.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,e.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,e.numLightProbeGrids)}function Vg(i,e){return i.replace(/NUM_CLIPPING_PLANES/g,e.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,e.numClippingPlanes-e.numClipIntersection)}var Ow=/^[ \t]*#include +<([\w\d./]+)>/gm;function Sf(i){return i.replace(Ow,Uw)}function Uw(i,e){let t=ft[e];if(t===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+e+">");return Sf(t)}var kw=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function Gg(i){return i.replace(kw,Bw)}function Bw(i,e,t,n){let s="";for(let r=parseInt(e);r<parseInt(t);r++)s+=n.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function Hg(i){let e=`precision ${i.precision} float;
	precision ${i.precision} int;
	precision ${i.precision} sampler2D;
	precision ${i.precision} samplerCube;
	precision ${i.precision} sampler3D;
	precision ${i.precision} sampler2DArray;
	precision ${i.precision} sampler2DShadow;
	precision ${i.precision} samplerCubeShadow;
	precision ${i.precision} sampler2DArrayShadow;
	precision ${i.precision} isampler2D;
	precision ${i.precision} isampler3D;
	precision ${i.precision} isamplerCube;
	precision ${i.precision} isampler2DArray;
	precision ${i.precision} usampler2D;
	precision ${i.precision} usampler3D;
	precision ${i.precision} usamplerCube;
	precision ${i.precision} usampler2DArray;
	`;return i.precision==="highp"?e+=`
#define HIGH_PRECISION`:i.precision==="mediump"?e+=`
#define MEDIUM_PRECISION`:i.precision==="lowp"&&(e+=`
#define LOW_PRECISION`),e}var zw={[yr]:"SHADOWMAP_TYPE_PCF",[go]:"SHADOWMAP_TYPE_VSM"};function Vw(i){return zw[i.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}var Gw={[xo]:"ENVMAP_MODE_REFRACTION"};function Hw(i){return i.envMap===!1?"ENVMAP_MODE_REFLECTION":Gw[i.envMapMode]||"ENVMAP_MODE_REFLECTION"}var Ww={[bc]:"ENVMAP_BLENDING_MULTIPLY",[rg]:"ENVMAP_BLENDING_MIX",[og]:"ENVMAP_BLENDING_ADD"};function Xw(i){return i.envMap===!1?"ENVMAP_BLENDING_NONE":Ww[i.combine]||"ENVMAP_BLENDING_NONE"}function qw(i,e,t,n){let s=i.getContext(),r=t.defines,o=t.vertexShader,a=t.fragmentShader,l=Vw(t),c=t.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",h=Hw(t),u=Xw(t),d=Nw(t),f=Dw(r),m=s.createProgram(),_,g,p=t.glslVersion?"#version "+t.glslVersion+`
`:"";t.isRawShaderMaterial?(_=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(ka).join(`
`),_.length>0&&(_+=`
`),g=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(ka).join(`
`),g.length>0&&(g+=`
`)):(_=[Hg(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",t.batching?"#define USE_BATCHING":"",t.batchingColor?"#define USE_BATCHING_COLOR":"",t.instancing?"#define USE_INSTANCING":"",t.instancingColor?"#define USE_INSTANCING_COLOR":"",t.instancingMorph?"#define USE_INSTANCING_MORPH":"",t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.map?"#define USE_MAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+h:"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.displacementMap?"#define USE_DISPLACEMENTMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.mapUv?"#define MAP_UV "+t.mapUv:"",t.alphaMapUv?"#define ALPHAMAP_UV "+t.alphaMapUv:"",t.lightMapUv?"#define LIGHTMAP_UV "+t.lightMapUv:"",t.aoMapUv?"#define AOMAP_UV "+t.aoMapUv:"",t.emissiveMapUv?"#define EMISSIVEMAP_UV "+t.emissiveMapUv:"",t.bumpMapUv?"#define BUMPMAP_UV "+t.bumpMapUv:"",t.normalMapUv?"#define NORMALMAP_UV "+t.normalMapUv:"",t.displacementMapUv?"#define DISPLACEMENTMAP_UV "+t.displacementMapUv:"",t.metalnessMapUv?"#define METALNESSMAP_UV "+t.metalnessMapUv:"",t.roughnessMapUv?"#define ROUGHNESSMAP_UV "+t.roughnessMapUv:"",t.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+t.anisotropyMapUv:"",t.clearcoatMapUv?"#define CLEARCOATMAP_UV "+t.clearcoatMapUv:"",t.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+t.clearcoatNormalMapUv:"",t.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+t.clearcoatRoughnessMapUv:"",t.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+t.diffuseRoughnessMapUv:"",t.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+t.iridescenceMapUv:"",t.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+t.iridescenceThicknessMapUv:"",t.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+t.sheenColorMapUv:"",t.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+t.sheenRoughnessMapUv:"",t.specularMapUv?"#define SPECULARMAP_UV "+t.specularMapUv:"",t.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+t.specularColorMapUv:"",t.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+t.specularIntensityMapUv:"",t.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+t.transmissionMapUv:"",t.thicknessMapUv?"#define THICKNESSMAP_UV "+t.thicknessMapUv:"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexNormals?"#define HAS_NORMAL":"",t.vertexColors?"#define USE_COLOR":"",t.vertexAlphas?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.flatShading?"#define FLAT_SHADED":"",t.skinning?"#define USE_SKINNING":"",t.morphTargets?"#define USE_MORPHTARGETS":"",t.morphNormals&&t.flatShading===!1?"#define USE_MORPHNORMALS":"",t.morphColors?"#define USE_MORPHCOLORS":"",t.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+t.morphTextureStride:"",t.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+t.morphTargetsCount:"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.sizeAttenuation?"#define USE_SIZEATTENUATION":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(ka).join(`
`),g=[Hg(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",t.map?"#define USE_MAP":"",t.matcap?"#define USE_MATCAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+c:"",t.envMap?"#define "+h:"",t.envMap?"#define "+u:"",t.envMapPMREM?"#define ENVMAP_MAX_LOD "+t.envMapMaxLod+".0":"",t.envMapPMREM?"#define ENVMAP_SIZE "+t.envMapSize+".0":"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoat?"#define USE_CLEARCOAT":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.dispersion?"#define USE_DISPERSION":"",t.retroreflection?"#define USE_RETROREFLECTION":"",t.iridescence?"#define USE_IRIDESCENCE":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaTest?"#define USE_ALPHATEST":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.sheen?"#define USE_SHEEN":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexColors||t.instancingColor?"#define USE_COLOR":"",t.vertexAlphas||t.batchingColor?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.gradientMap?"#define USE_GRADIENTMAP":"",t.flatShading?"#define FLAT_SHADED":"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",t.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",t.toneMapping!==cs?"#define TONE_MAPPING":"",t.toneMapping!==cs?ft.tonemapping_pars_fragment:"",t.toneMapping!==cs?Lw("toneMapping",t.toneMapping):"",t.dithering?"#define DITHERING":"",t.opaque?"#define OPAQUE":"",ft.colorspace_pars_fragment,Rw("linearToOutputTexel",t.outputColorSpace),Iw(),t.useDepthPacking?"#define DEPTH_PACKING "+t.depthPacking:"",`
`].filter(ka).join(`
`)),o=Sf(o),o=zg(o,t),o=Vg(o,t),a=Sf(a),a=zg(a,t),a=Vg(a,t),o=Gg(o),a=Gg(a),t.isRawShaderMaterial!==!0&&(p=`#version 300 es
`,_=[d,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+_,g=["#define varying in",t.glslVersion===lf?"":"layout(location = 0) out highp vec4 pc_fragColor;",t.glslVersion===lf?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+g);let y=p+_+o,A=p+g+a,S=Ug(s,s.VERTEX_SHADER,y),P=Ug(s,s.FRAGMENT_SHADER,A);s.attachShader(m,S),s.attachShader(m,P),t.index0AttributeName!==void 0?s.bindAttribLocation(m,0,t.index0AttributeName):t.hasPositionAttribute===!0&&s.bindAttribLocation(m,0,"position"),s.linkProgram(m);function E(D){if(i.debug.checkShaderErrors){let N=s.getProgramInfoLog(m)||"",z=s.getShaderInfoLog(S)||"",H=s.getShaderInfoLog(P)||"",I=N.trim(),W=z.trim(),$=H.trim(),G=!0,ce=!0;if(s.getProgramParameter(m,s.LINK_STATUS)===!1)if(G=!1,typeof i.debug.onShaderError=="function")i.debug.onShaderError(s,m,S,P);else{let J=Bg(s,S,"vertex"),Q=Bg(s,P,"fragment");nt("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(m,s.VALIDATE_STATUS)+`

Material Name: `+D.name+`
Material Type: `+D.type+`

Program Info Log: `+I+`
`+J+`
`+Q)}else I!==""?$e("WebGLProgram: Program Info Log:",I):(W===""||$==="")&&(ce=!1);ce&&(D.diagnostics={runnable:G,programLog:I,vertexShader:{log:W,prefix:_},fragmentShader:{log:$,prefix:g}})}s.deleteShader(S),s.deleteShader(P),x=new bo(s,m),T=Fw(s,m)}let x;this.getUniforms=function(){return x===void 0&&E(this),x};let T;this.getAttributes=function(){return T===void 0&&E(this),T};let k=t.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return k===!1&&(k=s.getProgramParameter(m,Tw)),k},this.destroy=function(){n.releaseStatesOfProgram(this),s.deleteProgram(m),this.program=void 0},this.type=t.shaderType,this.name=t.shaderName,this.id=Ew++,this.cacheKey=e,this.usedTimes=1,this.program=m,this.vertexShader=S,this.fragmentShader=P,this}var Yw=0,Mf=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,n){let s=this._getShaderCacheForMaterial(e);return s.has(t)===!1&&(s.add(t),t.usedTimes++),s.has(n)===!1&&(s.add(n),n.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let n of t)n.usedTimes--,n.usedTimes===0&&this.shaderCache.delete(n.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}_getShaderStage(e){let t=this.shaderCache,n=t.get(e);return n===void 0&&(n=new wf(e),t.set(e,n)),n}},wf=class{constructor(e){this.id=Yw++,this.code=e,this.usedTimes=0}};function $w(i){return i===er||i===Da||i===Fa}function Zw(i,e,t,n,s,r){let o=new ca,a=new Mf,l=new Set,c=[],h=new Map,u=n.logarithmicDepthBuffer,d={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function f(x){return l.add(x),x===0?"uv":`uv${x}`}function m(x,T,k,D,N,z){let H=D.fog,I=N.geometry,W=x.isMeshStandardMaterial||x.isMeshLambertMaterial||x.isMeshPhongMaterial?D.environment:null,$=x.isMeshStandardMaterial||x.isMeshLambertMaterial&&!x.envMap||x.isMeshPhongMaterial&&!x.envMap,G=e.get(x.envMap||W,$),ce=d[x.type],J=n.precision;x.precision!==null&&(J=n.getMaxPrecision(x.precision),J!==x.precision&&$e("WebGLProgram.getParameters:",x.precision,"not supported, using",J,"instead."));let Q=I.morphAttributes.position||I.morphAttributes.normal||I.morphAttributes.color,se=Q!==void 0?Q.length:0,de=0;I.morphAttributes.position!==void 0&&(de=1),I.morphAttributes.normal!==void 0&&(de=2),I.morphAttributes.color!==void 0&&(de=3);let ue,ee,me,xe;if(ce){let Ce=us[ce];ue=Ce.vertexShader,ee=Ce.fragmentShader}else{ue=x.vertexShader,ee=x.fragmentShader;let Ce=a.getVertexShaderStage(x),lt=a.getFragmentShaderStage(x);a.update(x,Ce,lt),me=Ce.id,xe=lt.id}let Ae=i.getRenderTarget(),Se=i.state.buffers.depth.getReversed(),We=N.isInstancedMesh===!0,ot=N.isBatchedMesh===!0,Ve=!!x.map,mt=!!x.matcap,ht=!!G,st=ht&&G.isPMREMTexture===!0,Jt=!!x.aoMap,Ht=!!x.lightMap,un=!!x.bumpMap&&x.wireframe===!1,Ut=!!x.normalMap,En=!!x.displacementMap,wt=!!x.emissiveMap,yn=!!x.metalnessMap,nn=!!x.roughnessMap,dn=x.anisotropy>0,O=x.clearcoat>0,Re=x.diffuseRoughness>0,Ze=x.dispersion>0,at=x.retroreflectivity>0,Me=x.iridescence>0,Bt=x.sheen>0,ze=x.transmission>0,Ye=dn&&!!x.anisotropyMap,C=O&&!!x.clearcoatMap,b=O&&!!x.clearcoatNormalMap,q=O&&!!x.clearcoatRoughnessMap,he=Re&&!!x.diffuseRoughnessMap,oe=Me&&!!x.iridescenceMap,ve=Me&&!!x.iridescenceThicknessMap,ye=Bt&&!!x.sheenColorMap,te=Bt&&!!x.sheenRoughnessMap,ie=!!x.specularMap,pe=!!x.specularColorMap,F=!!x.specularIntensityMap,re=ze&&!!x.transmissionMap,ne=ze&&!!x.thicknessMap,we=!!x.gradientMap,ge=!!x.alphaMap,be=x.alphaTest>0,Ge=!!x.alphaHash,je=!!x.extensions,le=cs;x.toneMapped&&(Ae===null||Ae.isXRRenderTarget===!0)&&(le=i.toneMapping);let Ue=st?G.isCompressedCubeTexture?G.image[0].mipmaps:G.mipmaps:null,Qe={shaderID:ce,shaderType:x.type,shaderName:x.name,vertexShader:ue,fragmentShader:ee,defines:x.defines,customVertexShaderID:me,customFragmentShaderID:xe,isRawShaderMaterial:x.isRawShaderMaterial===!0,glslVersion:x.glslVersion,precision:J,batching:ot,batchingColor:ot&&N._colorsTexture!==null,instancing:We,instancingColor:We&&N.instanceColor!==null,instancingMorph:We&&N.morphTexture!==null,outputColorSpace:Ae===null?i.outputColorSpace:Ae.isXRRenderTarget===!0?Ae.texture.colorSpace:yt.workingColorSpace,alphaToCoverage:!!x.alphaToCoverage,map:Ve,matcap:mt,envMap:ht,envMapMode:ht&&G.mapping,envMapPMREM:st,envMapMaxLod:st?Ue.length-1:null,envMapSize:st?Ue[0].width:null,aoMap:Jt,lightMap:Ht,bumpMap:un,normalMap:Ut,displacementMap:En,emissiveMap:wt,normalMapObjectSpace:Ut&&x.normalMapType===cg,normalMapTangentSpace:Ut&&x.normalMapType===Oa,packedNormalMap:Ut&&x.normalMapType===Oa&&$w(x.normalMap.format),metalnessMap:yn,roughnessMap:nn,anisotropy:dn,anisotropyMap:Ye,clearcoat:O,clearcoatMap:C,clearcoatNormalMap:b,clearcoatRoughnessMap:q,diffuseRoughness:Re,diffuseRoughnessMap:he,dispersion:Ze,retroreflection:at,iridescence:Me,iridescenceMap:oe,iridescenceThicknessMap:ve,sheen:Bt,sheenColorMap:ye,sheenRoughnessMap:te,specularMap:ie,specularColorMap:pe,specularIntensityMap:F,transmission:ze,transmissionMap:re,thicknessMap:ne,gradientMap:we,opaque:x.transparent===!1&&x.blending===vo&&x.alphaToCoverage===!1,alphaMap:ge,alphaTest:be,alphaHash:Ge,combine:x.combine,mapUv:Ve&&f(x.map.channel),aoMapUv:Jt&&f(x.aoMap.channel),lightMapUv:Ht&&f(x.lightMap.channel),bumpMapUv:un&&f(x.bumpMap.channel),normalMapUv:Ut&&f(x.normalMap.channel),displacementMapUv:En&&f(x.displacementMap.channel),emissiveMapUv:wt&&f(x.emissiveMap.channel),metalnessMapUv:yn&&f(x.metalnessMap.channel),roughnessMapUv:nn&&f(x.roughnessMap.channel),anisotropyMapUv:Ye&&f(x.anisotropyMap.channel),clearcoatMapUv:C&&f(x.clearcoatMap.channel),clearcoatNormalMapUv:b&&f(x.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:q&&f(x.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:he&&f(x.diffuseRoughnessMap.channel),iridescenceMapUv:oe&&f(x.iridescenceMap.channel),iridescenceThicknessMapUv:ve&&f(x.iridescenceThicknessMap.channel),sheenColorMapUv:ye&&f(x.sheenColorMap.channel),sheenRoughnessMapUv:te&&f(x.sheenRoughnessMap.channel),specularMapUv:ie&&f(x.specularMap.channel),specularColorMapUv:pe&&f(x.specularColorMap.channel),specularIntensityMapUv:F&&f(x.specularIntensityMap.channel),transmissionMapUv:re&&f(x.transmissionMap.channel),thicknessMapUv:ne&&f(x.thicknessMap.channel),alphaMapUv:ge&&f(x.alphaMap.channel),vertexTangents:!!I.attributes.tangent&&(Ut||dn),vertexNormals:!!I.attributes.normal,vertexColors:x.vertexColors,vertexAlphas:x.vertexColors===!0&&!!I.attributes.color&&I.attributes.color.itemSize===4,pointsUvs:N.isPoints===!0&&!!I.attributes.uv&&(Ve||ge),fog:!!H,useFog:x.fog===!0,fogExp2:!!H&&H.isFogExp2,flatShading:x.wireframe===!1&&(x.flatShading===!0||I.attributes.normal===void 0&&Ut===!1&&(x.isMeshLambertMaterial||x.isMeshPhongMaterial||x.isMeshStandardMaterial||x.isMeshPhysicalMaterial)),sizeAttenuation:x.sizeAttenuation===!0,logarithmicDepthBuffer:u,reversedDepthBuffer:Se,skinning:N.isSkinnedMesh===!0,hasPositionAttribute:I.attributes.position!==void 0,morphTargets:I.morphAttributes.position!==void 0,morphNormals:I.morphAttributes.normal!==void 0,morphColors:I.morphAttributes.color!==void 0,morphTargetsCount:se,morphTextureStride:de,numSunLights:T.sun.length,numDirLights:T.directional.length,numPointLights:T.point.length,numSpotLights:T.spot.length,numSpotLightMaps:T.spotLightMap.length,numRectAreaLights:T.rectArea.length,numHemiLights:T.hemi.length,numSunLightShadows:T.sunShadowMap.length,numDirLightShadows:T.directionalShadowMap.length,numPointLightShadows:T.pointShadowMap.length,numSpotLightShadows:T.spotShadowMap.length,numSpotLightShadowsWithMaps:T.numSpotLightShadowsWithMaps,numLightProbes:T.numLightProbes,numLightProbeGrids:z.filter(Ce=>Ce.texture!==null).length,numClippingPlanes:r.numPlanes,numClipIntersection:r.numIntersection,dithering:x.dithering,shadowMapEnabled:i.shadowMap.enabled&&k.length>0,shadowMapType:i.shadowMap.type,toneMapping:le,decodeVideoTexture:Ve&&x.map.isVideoTexture===!0&&yt.getTransfer(x.map.colorSpace)===It,decodeVideoTextureEmissive:wt&&x.emissiveMap.isVideoTexture===!0&&yt.getTransfer(x.emissiveMap.colorSpace)===It,premultipliedAlpha:x.premultipliedAlpha,doubleSided:x.side===Ai,flipSided:x.side===Un,useDepthPacking:x.depthPacking>=0,depthPacking:x.depthPacking||0,index0AttributeName:x.index0AttributeName,extensionClipCullDistance:je&&x.extensions.clipCullDistance===!0&&t.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(je&&x.extensions.multiDraw===!0||ot)&&t.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:t.has("KHR_parallel_shader_compile"),customProgramCacheKey:x.customProgramCacheKey()};return Qe.vertexUv1s=l.has(1),Qe.vertexUv2s=l.has(2),Qe.vertexUv3s=l.has(3),l.clear(),Qe}function _(x){let T=[];if(x.shaderID?T.push(x.shaderID):(T.push(x.customVertexShaderID),T.push(x.customFragmentShaderID)),x.defines!==void 0)for(let k in x.defines)T.push(k),T.push(x.defines[k]);return x.isRawShaderMaterial===!1&&(g(T,x),p(T,x),T.push(i.outputColorSpace)),T.push(x.customProgramCacheKey),T.join()}function g(x,T){x.push(T.precision),x.push(T.outputColorSpace),x.push(T.envMapMode),x.push(T.envMapPMREM),x.push(T.envMapMaxLod),x.push(T.envMapSize),x.push(T.mapUv),x.push(T.alphaMapUv),x.push(T.lightMapUv),x.push(T.aoMapUv),x.push(T.bumpMapUv),x.push(T.normalMapUv),x.push(T.displacementMapUv),x.push(T.emissiveMapUv),x.push(T.metalnessMapUv),x.push(T.roughnessMapUv),x.push(T.anisotropyMapUv),x.push(T.clearcoatMapUv),x.push(T.clearcoatNormalMapUv),x.push(T.clearcoatRoughnessMapUv),x.push(T.diffuseRoughnessMapUv),x.push(T.iridescenceMapUv),x.push(T.iridescenceThicknessMapUv),x.push(T.sheenColorMapUv),x.push(T.sheenRoughnessMapUv),x.push(T.specularMapUv),x.push(T.specularColorMapUv),x.push(T.specularIntensityMapUv),x.push(T.transmissionMapUv),x.push(T.thicknessMapUv),x.push(T.combine),x.push(T.fogExp2),x.push(T.sizeAttenuation),x.push(T.morphTargetsCount),x.push(T.numSunLights),x.push(T.numDirLights),x.push(T.numPointLights),x.push(T.numSpotLights),x.push(T.numSpotLightMaps),x.push(T.numHemiLights),x.push(T.numRectAreaLights),x.push(T.numSunLightShadows),x.push(T.numDirLightShadows),x.push(T.numPointLightShadows),x.push(T.numSpotLightShadows),x.push(T.numSpotLightShadowsWithMaps),x.push(T.numLightProbes),x.push(T.numLightProbeGrids),x.push(T.shadowMapType),x.push(T.toneMapping),x.push(T.numClippingPlanes),x.push(T.numClipIntersection),x.push(T.depthPacking)}function p(x,T){o.disableAll(),T.instancing&&o.enable(0),T.instancingColor&&o.enable(1),T.instancingMorph&&o.enable(2),T.matcap&&o.enable(3),T.envMap&&o.enable(4),T.normalMapObjectSpace&&o.enable(5),T.normalMapTangentSpace&&o.enable(6),T.clearcoat&&o.enable(7),T.iridescence&&o.enable(8),T.alphaTest&&o.enable(9),T.vertexColors&&o.enable(10),T.vertexAlphas&&o.enable(11),T.vertexUv1s&&o.enable(12),T.vertexUv2s&&o.enable(13),T.vertexUv3s&&o.enable(14),T.vertexTangents&&o.enable(15),T.anisotropy&&o.enable(16),T.alphaHash&&o.enable(17),T.batching&&o.enable(18),T.dispersion&&o.enable(19),T.retroreflection&&o.enable(24),T.diffuseRoughness&&o.enable(25),T.batchingColor&&o.enable(20),T.gradientMap&&o.enable(21),T.packedNormalMap&&o.enable(22),T.vertexNormals&&o.enable(23),x.push(o.mask),o.disableAll(),T.fog&&o.enable(0),T.useFog&&o.enable(1),T.flatShading&&o.enable(2),T.logarithmicDepthBuffer&&o.enable(3),T.reversedDepthBuffer&&o.enable(4),T.skinning&&o.enable(5),T.morphTargets&&o.enable(6),T.morphNormals&&o.enable(7),T.morphColors&&o.enable(8),T.premultipliedAlpha&&o.enable(9),T.shadowMapEnabled&&o.enable(10),T.doubleSided&&o.enable(11),T.flipSided&&o.enable(12),T.useDepthPacking&&o.enable(13),T.dithering&&o.enable(14),T.transmission&&o.enable(15),T.sheen&&o.enable(16),T.opaque&&o.enable(17),T.pointsUvs&&o.enable(18),T.decodeVideoTexture&&o.enable(19),T.decodeVideoTextureEmissive&&o.enable(20),T.alphaToCoverage&&o.enable(21),T.numLightProbeGrids>0&&o.enable(22),T.hasPositionAttribute&&o.enable(23),x.push(o.mask)}function y(x){let T=d[x.type],k;if(T){let D=us[T];k=wg.clone(D.uniforms)}else k=x.uniforms;return k}function A(x,T){let k=h.get(T);return k!==void 0?++k.usedTimes:(k=new qw(i,T,x,s),c.push(k),h.set(T,k)),k}function S(x){if(--x.usedTimes===0){let T=c.indexOf(x);c[T]=c[c.length-1],c.pop(),h.delete(x.cacheKey),x.destroy()}}function P(x){a.remove(x)}function E(){a.dispose()}return{getParameters:m,getProgramCacheKey:_,getUniforms:y,acquireProgram:A,releaseProgram:S,releaseShaderCache:P,programs:c,dispose:E}}function Kw(){let i=new WeakMap;function e(o){return i.has(o)}function t(o){let a=i.get(o);return a===void 0&&(a={},i.set(o,a)),a}function n(o){i.delete(o)}function s(o,a,l){i.get(o)[a]=l}function r(){i=new WeakMap}return{has:e,get:t,remove:n,update:s,dispose:r}}function Jw(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.material.id!==e.material.id?i.material.id-e.material.id:i.materialVariant!==e.materialVariant?i.materialVariant-e.materialVariant:i.z!==e.z?i.z-e.z:i.id-e.id}function Wg(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.z!==e.z?e.z-i.z:i.id-e.id}function Xg(){let i=[],e=0,t=[],n=[],s=[];function r(){e=0,t.length=0,n.length=0,s.length=0}function o(d){let f=0;return d.isInstancedMesh&&(f+=2),d.isSkinnedMesh&&(f+=1),f}function a(d,f,m,_,g,p){let y=i[e];return y===void 0?(y={id:d.id,object:d,geometry:f,material:m,materialVariant:o(d),groupOrder:_,renderOrder:d.renderOrder,z:g,group:p},i[e]=y):(y.id=d.id,y.object=d,y.geometry=f,y.material=m,y.materialVariant=o(d),y.groupOrder=_,y.renderOrder=d.renderOrder,y.z=g,y.group=p),e++,y}function l(d,f,m,_,g,p,y){y.reversedDepth===!0&&(g=-g);let A=a(d,f,m,_,g,p);m.transmission>0?n.push(A):m.transparent===!0?s.push(A):t.push(A)}function c(d,f,m,_,g,p){let y=a(d,f,m,_,g,p);m.transmission>0?n.unshift(y):m.transparent===!0?s.unshift(y):t.unshift(y)}function h(d,f){t.length>1&&t.sort(d||Jw),n.length>1&&n.sort(f||Wg),s.length>1&&s.sort(f||Wg)}function u(){for(let d=e,f=i.length;d<f;d++){let m=i[d];if(m.id===null)break;m.id=null,m.object=null,m.geometry=null,m.material=null,m.group=null}}return{opaque:t,transmissive:n,transparent:s,init:r,push:l,unshift:c,finish:u,sort:h}}function jw(){let i=new WeakMap;function e(n,s){let r=i.get(n),o;return r===void 0?(o=new Xg,i.set(n,[o])):s>=r.length?(o=new Xg,r.push(o)):o=r[s],o}function t(){i=new WeakMap}return{get:e,dispose:t}}function Qw(){let i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={direction:new U,color:new qe};break;case"SpotLight":t={position:new U,direction:new U,color:new qe,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":t={position:new U,color:new qe,distance:0,decay:0};break;case"HemisphereLight":t={direction:new U,skyColor:new qe,groundColor:new qe};break;case"RectAreaLight":t={color:new qe,position:new U,halfWidth:new U,halfHeight:new U};break}return i[e.id]=t,t}}}function e1(){let i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new He};break;case"SpotLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new He};break;case"PointLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new He,shadowCameraNear:1,shadowCameraFar:1e3};break}return i[e.id]=t,t}}}var t1=0;function n1(i,e){return(e.castShadow?2:0)-(i.castShadow?2:0)+(e.map?1:0)-(i.map?1:0)}function i1(i){let e=new Qw,t=e1(),n={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)n.probe.push(new U);let s=new U,r=new dt,o=new dt;function a(c){let h=0,u=0,d=0;for(let z=0;z<9;z++)n.probe[z].set(0,0,0);let f=0,m=0,_=0,g=0,p=0,y=0,A=0,S=0,P=0,E=0,x=0,T=0,k=0,D=0;c.sort(n1);for(let z=0,H=c.length;z<H;z++){let I=c[z],W=I.color,$=I.intensity,G=I.distance,ce=null;if(I.shadow&&I.shadow.map&&(I.shadow.map.texture.format===er?ce=I.shadow.map.texture:ce=I.shadow.map.depthTexture||I.shadow.map.texture),I.isAmbientLight)h+=W.r*$,u+=W.g*$,d+=W.b*$;else if(I.isLightProbe){for(let J=0;J<9;J++)n.probe[J].addScaledVector(I.sh.coefficients[J],$);D++}else if(I.isSunLight){let J=e.get(I);if(J.color.copy(I.color).multiplyScalar(I.intensity),I.castShadow){let Q=I.shadow,se=t.get(I);se.shadowIntensity=Q.intensity,se.shadowBias=Q.bias,se.shadowNormalBias=Q.normalBias,se.shadowRadius=Q.radius,se.shadowMapSize.copy(Q.mapSize).multiply(Q.getFrameExtents()),n.sunShadow[m]=se,n.sunShadowMap[m]=ce;let de=Q.getViewportCount();for(let ue=0;ue<de;ue++)n.sunShadowMatrix[_+ue]=Q.getMatrix(ue),n.sunShadowCascade[_+ue]=Q._cascadeData[ue];_+=de,m++}n.sun[f]=J,f++}else if(I.isDirectionalLight){let J=e.get(I);if(J.color.copy(I.color).multiplyScalar(I.intensity),I.castShadow){let Q=I.shadow,se=t.get(I);se.shadowIntensity=Q.intensity,se.shadowBias=Q.bias,se.shadowNormalBias=Q.normalBias,se.shadowRadius=Q.radius,se.shadowMapSize=Q.mapSize,n.directionalShadow[g]=se,n.directionalShadowMap[g]=ce,n.directionalShadowMatrix[g]=I.shadow.matrix,P++}n.directional[g]=J,g++}else if(I.isSpotLight){let J=e.get(I);J.position.setFromMatrixPosition(I.matrixWorld),J.color.copy(W).multiplyScalar($),J.distance=G,J.coneCos=Math.cos(I.angle),J.penumbraCos=Math.cos(I.angle*(1-I.penumbra)),J.decay=I.decay,n.spot[y]=J;let Q=I.shadow;if(I.map&&(n.spotLightMap[T]=I.map,T++,Q.updateMatrices(I),I.castShadow&&k++),n.spotLightMatrix[y]=Q.matrix,I.castShadow){let se=t.get(I);se.shadowIntensity=Q.intensity,se.shadowBias=Q.bias,se.shadowNormalBias=Q.normalBias,se.shadowRadius=Q.radius,se.shadowMapSize=Q.mapSize,n.spotShadow[y]=se,n.spotShadowMap[y]=ce,x++}y++}else if(I.isRectAreaLight){let J=e.get(I);J.color.copy(W).multiplyScalar($),J.halfWidth.set(I.width*.5,0,0),J.halfHeight.set(0,I.height*.5,0),n.rectArea[A]=J,A++}else if(I.isPointLight){let J=e.get(I);if(J.color.copy(I.color).multiplyScalar(I.intensity),J.distance=I.distance,J.decay=I.decay,I.castShadow){let Q=I.shadow,se=t.get(I);se.shadowIntensity=Q.intensity,se.shadowBias=Q.bias,se.shadowNormalBias=Q.normalBias,se.shadowRadius=Q.radius,se.shadowMapSize=Q.mapSize,se.shadowCameraNear=Q.camera.near,se.shadowCameraFar=Q.camera.far,n.pointShadow[p]=se,n.pointShadowMap[p]=ce,n.pointShadowMatrix[p]=I.shadow.matrix,E++}n.point[p]=J,p++}else if(I.isHemisphereLight){let J=e.get(I);J.skyColor.copy(I.color).multiplyScalar($),J.groundColor.copy(I.groundColor).multiplyScalar($),n.hemi[S]=J,S++}}A>0&&(i.has("OES_texture_float_linear")===!0?(n.rectAreaLTC1=Ie.LTC_FLOAT_1,n.rectAreaLTC2=Ie.LTC_FLOAT_2):(n.rectAreaLTC1=Ie.LTC_HALF_1,n.rectAreaLTC2=Ie.LTC_HALF_2)),n.ambient[0]=h,n.ambient[1]=u,n.ambient[2]=d;let N=n.hash;(N.sunLength!==f||N.directionalLength!==g||N.pointLength!==p||N.spotLength!==y||N.rectAreaLength!==A||N.hemiLength!==S||N.numSunShadows!==m||N.numDirectionalShadows!==P||N.numPointShadows!==E||N.numSpotShadows!==x||N.numSpotMaps!==T||N.numLightProbes!==D)&&(n.sun.length=f,n.directional.length=g,n.spot.length=y,n.rectArea.length=A,n.point.length=p,n.hemi.length=S,n.sunShadow.length=m,n.sunShadowMap.length=m,n.sunShadowMatrix.length=_,n.sunShadowCascade.length=_,n.directionalShadow.length=P,n.directionalShadowMap.length=P,n.directionalShadowMatrix.length=P,n.pointShadow.length=E,n.pointShadowMap.length=E,n.pointShadowMatrix.length=E,n.spotShadow.length=x,n.spotShadowMap.length=x,n.spotLightMatrix.length=x+T-k,n.spotLightMap.length=T,n.numSpotLightShadowsWithMaps=k,n.numLightProbes=D,N.sunLength=f,N.directionalLength=g,N.pointLength=p,N.spotLength=y,N.rectAreaLength=A,N.hemiLength=S,N.numSunShadows=m,N.numDirectionalShadows=P,N.numPointShadows=E,N.numSpotShadows=x,N.numSpotMaps=T,N.numLightProbes=D,n.version=t1++)}function l(c,h){let u=0,d=0,f=0,m=0,_=0,g=0,p=h.matrixWorldInverse;for(let y=0,A=c.length;y<A;y++){let S=c[y];if(S.isSunLight){let P=n.sun[u];P.direction.setFromMatrixPosition(S.matrixWorld),P.direction.transformDirection(p),u++}else if(S.isDirectionalLight){let P=n.directional[d];P.direction.setFromMatrixPosition(S.matrixWorld),s.setFromMatrixPosition(S.target.matrixWorld),P.direction.sub(s),P.direction.transformDirection(p),d++}else if(S.isSpotLight){let P=n.spot[m];P.position.setFromMatrixPosition(S.matrixWorld),P.position.applyMatrix4(p),P.direction.setFromMatrixPosition(S.matrixWorld),s.setFromMatrixPosition(S.target.matrixWorld),P.direction.sub(s),P.direction.transformDirection(p),m++}else if(S.isRectAreaLight){let P=n.rectArea[_];P.position.setFromMatrixPosition(S.matrixWorld),P.position.applyMatrix4(p),o.identity(),r.copy(S.matrixWorld),r.premultiply(p),o.extractRotation(r),P.halfWidth.set(S.width*.5,0,0),P.halfHeight.set(0,S.height*.5,0),P.halfWidth.applyMatrix4(o),P.halfHeight.applyMatrix4(o),_++}else if(S.isPointLight){let P=n.point[f];P.position.setFromMatrixPosition(S.matrixWorld),P.position.applyMatrix4(p),f++}else if(S.isHemisphereLight){let P=n.hemi[g];P.direction.setFromMatrixPosition(S.matrixWorld),P.direction.transformDirection(p),g++}}}return{setup:a,setupView:l,state:n}}function qg(i){let e=new i1(i),t=[],n=[],s=[];function r(u){h.camera=u,t.length=0,n.length=0,s.length=0}function o(u){u.isLightProbeGrid?s.push(u):t.push(u)}function a(u){n.push(u)}function l(){e.setup(t),s.sort((u,d)=>u.priority-d.priority||u.id-d.id)}function c(u){e.setupView(t,u)}let h={lightsArray:t,shadowsArray:n,lightProbeGridArray:s,camera:null,lights:e,transmissionRenderTarget:{},textureUnits:0};return{init:r,state:h,setupLights:l,setupLightsView:c,pushLight:o,pushShadow:a}}function s1(i){let e=new WeakMap;function t(s,r=0){let o=e.get(s),a;return o===void 0?(a=new qg(i),e.set(s,[a])):r>=o.length?(a=new qg(i),o.push(a)):a=o[r],a}function n(){e=new WeakMap}return{get:t,dispose:n}}var r1=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,o1=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,a1=[new U(1,0,0),new U(-1,0,0),new U(0,1,0),new U(0,-1,0),new U(0,0,1),new U(0,0,-1)],l1=[new U(0,-1,0),new U(0,-1,0),new U(0,0,1),new U(0,0,-1),new U(0,-1,0),new U(0,-1,0)],Yg=new dt,Ua=new U,xf=new U;function c1(i,e,t){let n=new Ys,s=new He,r=new He,o=new en,a=new ac,l=new lc,c={},h=t.maxTextureSize,u={[ls]:Un,[Un]:ls,[Ai]:Ai},d=new as({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new He},radius:{value:4}},vertexShader:r1,fragmentShader:o1}),f=d.clone();f.defines.HORIZONTAL_PASS=1;let m=new zt;m.setAttribute("position",new Qt(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let _=new ct(m,d),g=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=yr;let p=this.type;this.render=function(E,x,T){if(g.enabled===!1||g.autoUpdate===!1&&g.needsUpdate===!1||E.length===0)return;this.type===zm&&($e("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=yr);let k=i.getRenderTarget(),D=i.getActiveCubeFace(),N=i.getActiveMipmapLevel(),z=i.state;z.setBlending(_r),z.buffers.depth.getReversed()===!0?z.buffers.color.setClear(0,0,0,0):z.buffers.color.setClear(1,1,1,1),z.buffers.depth.setTest(!0),z.setScissorTest(!1);let H=p!==this.type;H&&x.traverse(function(I){I.material&&(Array.isArray(I.material)?I.material.forEach(W=>W.needsUpdate=!0):I.material.needsUpdate=!0)});for(let I=0,W=E.length;I<W;I++){let $=E[I],G=$.shadow;if(G===void 0){$e("WebGLShadowMap:",$,"has no shadow.");continue}if(G.autoUpdate===!1&&G.needsUpdate===!1)continue;s.copy(G.mapSize);let ce=G.getFrameExtents();s.multiply(ce),r.copy(G.mapSize),(s.x>h||s.y>h)&&(s.x>h&&(r.x=Math.floor(h/ce.x),s.x=r.x*ce.x,G.mapSize.x=r.x),s.y>h&&(r.y=Math.floor(h/ce.y),s.y=r.y*ce.y,G.mapSize.y=r.y));let J=i.state.buffers.depth.getReversed();if(G.camera._reversedDepth=J,G.map===null||H===!0){if(G.map!==null&&(G.map.depthTexture!==null&&(G.map.depthTexture.dispose(),G.map.depthTexture=null),G.map.dispose()),this.type===go){if($.isPointLight){$e("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}G.map=new fi(s.x,s.y,{format:er,type:zi,minFilter:Kn,magFilter:Kn,generateMipmaps:!1}),G.map.texture.name=$.name+".shadowMap",G.map.depthTexture=new Cs(s.x,s.y,Ci),G.map.depthTexture.name=$.name+".shadowMapDepth",G.map.depthTexture.format=Es,G.map.depthTexture.compareFunction=null,G.map.depthTexture.minFilter=In,G.map.depthTexture.magFilter=In}else $.isPointLight?(G.map=new Ba(s.x),G.map.depthTexture=new va(s.x,Bi)):(G.map=new fi(s.x,s.y),G.map.depthTexture=new Cs(s.x,s.y,Bi)),G.map.depthTexture.name=$.name+".shadowMap",G.map.depthTexture.format=Es,this.type===yr?(G.map.depthTexture.compareFunction=J?of:rf,G.map.depthTexture.minFilter=Kn,G.map.depthTexture.magFilter=Kn):(G.map.depthTexture.compareFunction=null,G.map.depthTexture.minFilter=In,G.map.depthTexture.magFilter=In);G.camera.updateProjectionMatrix()}G.map.isWebGLCubeRenderTarget!==!0&&(G.map.width!==s.x||G.map.height!==s.y)&&G.map.setSize(s.x,s.y);let Q=G.map.isWebGLCubeRenderTarget?6:G.getViewportCount();$.isPointLight!==!0&&G.updateMatrices($,T);let se=(G.camera.layers.mask&4294967294)!==0?G.camera.layers:T.layers;for(let de=0;de<Q;de++){let ue=G.getCamera(de);if($.isPointLight){let ee=G.camera,me=G.matrix,xe=$.distance||ee.far;xe!==ee.far&&(ee.far=xe,ee.updateProjectionMatrix()),Ua.setFromMatrixPosition($.matrixWorld),ee.position.copy(Ua),xf.copy(ee.position),xf.add(a1[de]),ee.up.copy(l1[de]),ee.lookAt(xf),ee.updateMatrixWorld(),me.makeTranslation(-Ua.x,-Ua.y,-Ua.z),Yg.multiplyMatrices(ee.projectionMatrix,ee.matrixWorldInverse),G._frustum.setFromProjectionMatrix(Yg,ee.coordinateSystem,ee.reversedDepth)}if(G.map.isWebGLCubeRenderTarget)i.setRenderTarget(G.map,de),i.clear();else{de===0&&(i.setRenderTarget(G.map),i.clear());let ee=G.getViewport(de);o.set(r.x*ee.x,r.y*ee.y,r.x*ee.z,r.y*ee.w),z.viewport(o)}n=G.getFrustum(de),S(x,T,ue,$,se,this.type)}G.isPointLightShadow!==!0&&this.type===go&&y(G,T),G.needsUpdate=!1}p=this.type,g.needsUpdate=!1,i.setRenderTarget(k,D,N)};function y(E,x){let T=e.update(_);d.defines.VSM_SAMPLES!==E.blurSamples&&(d.defines.VSM_SAMPLES=E.blurSamples,f.defines.VSM_SAMPLES=E.blurSamples,d.needsUpdate=!0,f.needsUpdate=!0),E.mapPass===null?E.mapPass=new fi(s.x,s.y,{format:er,type:zi}):(E.mapPass.width!==E.map.width||E.mapPass.height!==E.map.height)&&E.mapPass.setSize(E.map.width,E.map.height),d.uniforms.shadow_pass.value=E.map.depthTexture,d.uniforms.resolution.value.set(E.map.width,E.map.height),d.uniforms.radius.value=E.radius,i.setRenderTarget(E.mapPass),i.clear(),i.renderBufferDirect(x,null,T,d,_,null),f.uniforms.shadow_pass.value=E.mapPass.texture,f.uniforms.resolution.value.set(E.map.width,E.map.height),f.uniforms.radius.value=E.radius,i.setRenderTarget(E.map),i.clear(),i.renderBufferDirect(x,null,T,f,_,null)}function A(E,x,T,k){let D=null,N=T.isPointLight===!0?E.customDistanceMaterial:E.customDepthMaterial;if(N!==void 0)D=N;else if(D=T.isPointLight===!0?l:a,i.localClippingEnabled&&x.clipShadows===!0&&Array.isArray(x.clippingPlanes)&&x.clippingPlanes.length!==0||x.displacementMap&&x.displacementScale!==0||x.alphaMap&&x.alphaTest>0||x.map&&x.alphaTest>0||x.alphaToCoverage===!0){let z=D.uuid,H=x.uuid,I=c[z];I===void 0&&(I={},c[z]=I);let W=I[H];W===void 0&&(W=D.clone(),I[H]=W,x.addEventListener("dispose",P)),D=W}if(D.visible=x.visible,D.wireframe=x.wireframe,k===go?D.side=x.shadowSide!==null?x.shadowSide:x.side:D.side=x.shadowSide!==null?x.shadowSide:u[x.side],D.alphaMap=x.alphaMap,D.alphaTest=x.alphaToCoverage===!0?.5:x.alphaTest,D.map=x.map,D.clipShadows=x.clipShadows,D.clippingPlanes=x.clippingPlanes,D.clipIntersection=x.clipIntersection,D.displacementMap=x.displacementMap,D.displacementScale=x.displacementScale,D.displacementBias=x.displacementBias,D.wireframeLinewidth=x.wireframeLinewidth,D.linewidth=x.linewidth,T.isPointLight===!0&&D.isMeshDistanceMaterial===!0){let z=i.properties.get(D);z.light=T}return D}function S(E,x,T,k,D,N){if(E.visible===!1)return;if(E.layers.test(D)&&(E.isMesh||E.isLine||E.isPoints)&&(E.castShadow||E.receiveShadow&&N===go)&&(!E.frustumCulled||E.intersectsFrustum(n))){E.modelViewMatrix.multiplyMatrices(T.matrixWorldInverse,E.matrixWorld);let I=e.update(E),W=E.material;if(Array.isArray(W)){let $=I.groups;for(let G=0,ce=$.length;G<ce;G++){let J=$[G],Q=W[J.materialIndex];if(Q&&Q.visible){let se=A(E,Q,k,N);E.onBeforeShadow(i,E,x,T,I,se,J),i.renderBufferDirect(T,null,I,se,E,J),E.onAfterShadow(i,E,x,T,I,se,J)}}}else if(W.visible){let $=A(E,W,k,N);E.onBeforeShadow(i,E,x,T,I,$,null),i.renderBufferDirect(T,null,I,$,E,null),E.onAfterShadow(i,E,x,T,I,$,null)}}let H=E.children;for(let I=0,W=H.length;I<W;I++)S(H[I],x,T,k,D,N)}function P(E){E.target.removeEventListener("dispose",P);for(let T in c){let k=c[T],D=E.target.uuid;D in k&&(k[D].dispose(),delete k[D])}}}function h1(i,e){function t(){let F=!1,re=new en,ne=null,we=new en(0,0,0,0);return{setMask:function(ge){ne!==ge&&!F&&(i.colorMask(ge,ge,ge,ge),ne=ge)},setLocked:function(ge){F=ge},setClear:function(ge,be,Ge,je,le){le===!0&&(ge*=je,be*=je,Ge*=je),re.set(ge,be,Ge,je),we.equals(re)===!1&&(i.clearColor(ge,be,Ge,je),we.copy(re))},reset:function(){F=!1,ne=null,we.set(-1,0,0,0)}}}function n(){let F=!1,re=!1,ne=null,we=null,ge=null;return{setReversed:function(be){if(re!==be){let Ge=e.get("EXT_clip_control");be?Ge.clipControlEXT(Ge.LOWER_LEFT_EXT,Ge.ZERO_TO_ONE_EXT):Ge.clipControlEXT(Ge.LOWER_LEFT_EXT,Ge.NEGATIVE_ONE_TO_ONE_EXT),re=be;let je=ge;ge=null,this.setClear(je)}},getReversed:function(){return re},setTest:function(be){be?Se(i.DEPTH_TEST):We(i.DEPTH_TEST)},setMask:function(be){ne!==be&&!F&&(i.depthMask(be),ne=be)},setFunc:function(be){if(re&&(be=_g[be]),we!==be){switch(be){case Wl:i.depthFunc(i.NEVER);break;case Xl:i.depthFunc(i.ALWAYS);break;case ql:i.depthFunc(i.LESS);break;case oo:i.depthFunc(i.LEQUAL);break;case Yl:i.depthFunc(i.EQUAL);break;case $l:i.depthFunc(i.GEQUAL);break;case Zl:i.depthFunc(i.GREATER);break;case Kl:i.depthFunc(i.NOTEQUAL);break;default:i.depthFunc(i.LEQUAL)}we=be}},setLocked:function(be){F=be},setClear:function(be){ge!==be&&(ge=be,re&&(be=1-be),i.clearDepth(be))},reset:function(){F=!1,ne=null,we=null,ge=null,re=!1}}}function s(){let F=!1,re=null,ne=null,we=null,ge=null,be=null,Ge=null,je=null,le=null;return{setTest:function(Ue){F||(Ue?Se(i.STENCIL_TEST):We(i.STENCIL_TEST))},setMask:function(Ue){re!==Ue&&!F&&(i.stencilMask(Ue),re=Ue)},setFunc:function(Ue,Qe,Ce){(ne!==Ue||we!==Qe||ge!==Ce)&&(i.stencilFunc(Ue,Qe,Ce),ne=Ue,we=Qe,ge=Ce)},setOp:function(Ue,Qe,Ce){(be!==Ue||Ge!==Qe||je!==Ce)&&(i.stencilOp(Ue,Qe,Ce),be=Ue,Ge=Qe,je=Ce)},setLocked:function(Ue){F=Ue},setClear:function(Ue){le!==Ue&&(i.clearStencil(Ue),le=Ue)},reset:function(){F=!1,re=null,ne=null,we=null,ge=null,be=null,Ge=null,je=null,le=null}}}let r=new t,o=new n,a=new s,l={},c=new WeakMap,h={},u={},d={},f=new WeakMap,m=[],_=null,g=!1,p=null,y=null,A=null,S=null,P=null,E=null,x=null,T=new qe(0,0,0),k=0,D=!1,N=null,z=null,H=null,I=null,W=null,$=i.getParameter(i.MAX_COMBINED_TEXTURE_IMAGE_UNITS),G=!1,ce=0,J=i.getParameter(i.VERSION);J.indexOf("WebGL")!==-1?(ce=parseFloat(/^WebGL (\d)/.exec(J)[1]),G=ce>=1):J.indexOf("OpenGL ES")!==-1&&(ce=parseFloat(/^OpenGL ES (\d)/.exec(J)[1]),G=ce>=2);let Q=null,se={},de=i.getParameter(i.SCISSOR_BOX),ue=i.getParameter(i.VIEWPORT),ee=new en().fromArray(de),me=new en().fromArray(ue);function xe(F,re,ne,we){let ge=new Uint8Array(4),be=i.createTexture();i.bindTexture(F,be),i.texParameteri(F,i.TEXTURE_MIN_FILTER,i.NEAREST),i.texParameteri(F,i.TEXTURE_MAG_FILTER,i.NEAREST);for(let Ge=0;Ge<ne;Ge++)F===i.TEXTURE_3D||F===i.TEXTURE_2D_ARRAY?i.texImage3D(re,0,i.RGBA,1,1,we,0,i.RGBA,i.UNSIGNED_BYTE,ge):i.texImage2D(re+Ge,0,i.RGBA,1,1,0,i.RGBA,i.UNSIGNED_BYTE,ge);return be}let Ae={};Ae[i.TEXTURE_2D]=xe(i.TEXTURE_2D,i.TEXTURE_2D,1),Ae[i.TEXTURE_CUBE_MAP]=xe(i.TEXTURE_CUBE_MAP,i.TEXTURE_CUBE_MAP_POSITIVE_X,6),Ae[i.TEXTURE_2D_ARRAY]=xe(i.TEXTURE_2D_ARRAY,i.TEXTURE_2D_ARRAY,1,1),Ae[i.TEXTURE_3D]=xe(i.TEXTURE_3D,i.TEXTURE_3D,1,1),r.setClear(0,0,0,1),o.setClear(1),a.setClear(0),Se(i.DEPTH_TEST),o.setFunc(oo),un(!1),Ut(kd),Se(i.CULL_FACE),Jt(_r);function Se(F){h[F]!==!0&&(i.enable(F),h[F]=!0)}function We(F){h[F]!==!1&&(i.disable(F),h[F]=!1)}function ot(F,re){return d[F]!==re?(i.bindFramebuffer(F,re),d[F]=re,F===i.DRAW_FRAMEBUFFER&&(d[i.FRAMEBUFFER]=re),F===i.FRAMEBUFFER&&(d[i.DRAW_FRAMEBUFFER]=re),!0):!1}function Ve(F,re){let ne=m,we=!1;if(F){ne=f.get(re),ne===void 0&&(ne=[],f.set(re,ne));let ge=F.textures;if(ne.length!==ge.length||ne[0]!==i.COLOR_ATTACHMENT0){for(let be=0,Ge=ge.length;be<Ge;be++)ne[be]=i.COLOR_ATTACHMENT0+be;ne.length=ge.length,we=!0}}else ne[0]!==i.BACK&&(ne[0]=i.BACK,we=!0);we&&i.drawBuffers(ne)}function mt(F){return _!==F?(i.useProgram(F),_=F,!0):!1}let ht={[br]:i.FUNC_ADD,[Gm]:i.FUNC_SUBTRACT,[Hm]:i.FUNC_REVERSE_SUBTRACT};ht[Wm]=i.MIN,ht[Xm]=i.MAX;let st={[qm]:i.ZERO,[Ym]:i.ONE,[$m]:i.SRC_COLOR,[Gd]:i.SRC_ALPHA,[eg]:i.SRC_ALPHA_SATURATE,[jm]:i.DST_COLOR,[Km]:i.DST_ALPHA,[Zm]:i.ONE_MINUS_SRC_COLOR,[Hd]:i.ONE_MINUS_SRC_ALPHA,[Qm]:i.ONE_MINUS_DST_COLOR,[Jm]:i.ONE_MINUS_DST_ALPHA,[tg]:i.CONSTANT_COLOR,[ng]:i.ONE_MINUS_CONSTANT_COLOR,[ig]:i.CONSTANT_ALPHA,[sg]:i.ONE_MINUS_CONSTANT_ALPHA};function Jt(F,re,ne,we,ge,be,Ge,je,le,Ue){if(F===_r){g===!0&&(We(i.BLEND),g=!1);return}if(g===!1&&(Se(i.BLEND),g=!0),F!==Vm){if(F!==p||Ue!==D){if((y!==br||P!==br)&&(i.blendEquation(i.FUNC_ADD),y=br,P=br),Ue)switch(F){case vo:i.blendFuncSeparate(i.ONE,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case Bd:i.blendFunc(i.ONE,i.ONE);break;case zd:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case Vd:i.blendFuncSeparate(i.DST_COLOR,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE);break;default:nt("WebGLState: Invalid blending: ",F);break}else switch(F){case vo:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case Bd:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE,i.ONE,i.ONE);break;case zd:nt("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case Vd:nt("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:nt("WebGLState: Invalid blending: ",F);break}A=null,S=null,E=null,x=null,T.set(0,0,0),k=0,p=F,D=Ue}return}ge=ge||re,be=be||ne,Ge=Ge||we,(re!==y||ge!==P)&&(i.blendEquationSeparate(ht[re],ht[ge]),y=re,P=ge),(ne!==A||we!==S||be!==E||Ge!==x)&&(i.blendFuncSeparate(st[ne],st[we],st[be],st[Ge]),A=ne,S=we,E=be,x=Ge),(je.equals(T)===!1||le!==k)&&(i.blendColor(je.r,je.g,je.b,le),T.copy(je),k=le),p=F,D=!1}function Ht(F,re){F.side===Ai?We(i.CULL_FACE):Se(i.CULL_FACE);let ne=F.side===Un;re&&(ne=!ne),un(ne),F.blending===vo&&F.transparent===!1?Jt(_r):Jt(F.blending,F.blendEquation,F.blendSrc,F.blendDst,F.blendEquationAlpha,F.blendSrcAlpha,F.blendDstAlpha,F.blendColor,F.blendAlpha,F.premultipliedAlpha),o.setFunc(F.depthFunc),o.setTest(F.depthTest),o.setMask(F.depthWrite),r.setMask(F.colorWrite);let we=F.stencilWrite;a.setTest(we),we&&(a.setMask(F.stencilWriteMask),a.setFunc(F.stencilFunc,F.stencilRef,F.stencilFuncMask),a.setOp(F.stencilFail,F.stencilZFail,F.stencilZPass)),wt(F.polygonOffset,F.polygonOffsetFactor,F.polygonOffsetUnits),F.alphaToCoverage===!0?Se(i.SAMPLE_ALPHA_TO_COVERAGE):We(i.SAMPLE_ALPHA_TO_COVERAGE)}function un(F){N!==F&&(F?i.frontFace(i.CW):i.frontFace(i.CCW),N=F)}function Ut(F){F!==km?(Se(i.CULL_FACE),F!==z&&(F===kd?i.cullFace(i.BACK):F===Bm?i.cullFace(i.FRONT):i.cullFace(i.FRONT_AND_BACK))):We(i.CULL_FACE),z=F}function En(F){F!==H&&(G&&i.lineWidth(F),H=F)}function wt(F,re,ne){F?(Se(i.POLYGON_OFFSET_FILL),(I!==re||W!==ne)&&(I=re,W=ne,o.getReversed()&&(re=-re,ne=-ne),i.polygonOffset(re,ne))):We(i.POLYGON_OFFSET_FILL)}function yn(F){F?Se(i.SCISSOR_TEST):We(i.SCISSOR_TEST)}function nn(F){F===void 0&&(F=i.TEXTURE0+$-1),Q!==F&&(i.activeTexture(F),Q=F)}function dn(F,re,ne){ne===void 0&&(Q===null?ne=i.TEXTURE0+$-1:ne=Q);let we=se[ne];we===void 0&&(we={type:void 0,texture:void 0},se[ne]=we),(we.type!==F||we.texture!==re)&&(Q!==ne&&(i.activeTexture(ne),Q=ne),i.bindTexture(F,re||Ae[F]),we.type=F,we.texture=re)}function O(){let F=se[Q];F!==void 0&&F.type!==void 0&&(i.bindTexture(F.type,null),F.type=void 0,F.texture=void 0)}function Re(){try{i.compressedTexImage2D(...arguments)}catch(F){nt("WebGLState:",F)}}function Ze(){try{i.compressedTexImage3D(...arguments)}catch(F){nt("WebGLState:",F)}}function at(){try{i.texSubImage2D(...arguments)}catch(F){nt("WebGLState:",F)}}function Me(){try{i.texSubImage3D(...arguments)}catch(F){nt("WebGLState:",F)}}function Bt(){try{i.compressedTexSubImage2D(...arguments)}catch(F){nt("WebGLState:",F)}}function ze(){try{i.compressedTexSubImage3D(...arguments)}catch(F){nt("WebGLState:",F)}}function Ye(){try{i.texStorage2D(...arguments)}catch(F){nt("WebGLState:",F)}}function C(){try{i.texStorage3D(...arguments)}catch(F){nt("WebGLState:",F)}}function b(){try{i.texImage2D(...arguments)}catch(F){nt("WebGLState:",F)}}function q(){try{i.texImage3D(...arguments)}catch(F){nt("WebGLState:",F)}}function he(F){return u[F]!==void 0?u[F]:i.getParameter(F)}function oe(F,re){u[F]!==re&&(i.pixelStorei(F,re),u[F]=re)}function ve(F){ee.equals(F)===!1&&(i.scissor(F.x,F.y,F.z,F.w),ee.copy(F))}function ye(F){me.equals(F)===!1&&(i.viewport(F.x,F.y,F.z,F.w),me.copy(F))}function te(F,re){let ne=c.get(re);ne===void 0&&(ne=new WeakMap,c.set(re,ne));let we=ne.get(F);we===void 0&&(we=i.getUniformBlockIndex(re,F.name),i.uniformBlockBinding(re,we,we),ne.set(F,we))}function ie(F,re,ne){let ge=c.get(re).get(F);l[ge]!==ne&&(i.bindBufferBase(i.UNIFORM_BUFFER,ge,ne),l[ge]=ne)}function pe(){i.disable(i.BLEND),i.disable(i.CULL_FACE),i.disable(i.DEPTH_TEST),i.disable(i.POLYGON_OFFSET_FILL),i.disable(i.SCISSOR_TEST),i.disable(i.STENCIL_TEST),i.disable(i.SAMPLE_ALPHA_TO_COVERAGE),i.blendEquation(i.FUNC_ADD),i.blendFunc(i.ONE,i.ZERO),i.blendFuncSeparate(i.ONE,i.ZERO,i.ONE,i.ZERO),i.blendColor(0,0,0,0),i.colorMask(!0,!0,!0,!0),i.clearColor(0,0,0,0),i.depthMask(!0),i.depthFunc(i.LESS),o.setReversed(!1),i.clearDepth(1),i.stencilMask(4294967295),i.stencilFunc(i.ALWAYS,0,4294967295),i.stencilOp(i.KEEP,i.KEEP,i.KEEP),i.clearStencil(0),i.cullFace(i.BACK),i.frontFace(i.CCW),i.polygonOffset(0,0),i.activeTexture(i.TEXTURE0),i.bindFramebuffer(i.FRAMEBUFFER,null),i.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),i.bindFramebuffer(i.READ_FRAMEBUFFER,null),i.useProgram(null),i.lineWidth(1),i.scissor(0,0,i.canvas.width,i.canvas.height),i.viewport(0,0,i.canvas.width,i.canvas.height),i.pixelStorei(i.PACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,!1),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,i.BROWSER_DEFAULT_WEBGL),i.pixelStorei(i.PACK_ROW_LENGTH,0),i.pixelStorei(i.PACK_SKIP_PIXELS,0),i.pixelStorei(i.PACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_ROW_LENGTH,0),i.pixelStorei(i.UNPACK_IMAGE_HEIGHT,0),i.pixelStorei(i.UNPACK_SKIP_PIXELS,0),i.pixelStorei(i.UNPACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_SKIP_IMAGES,0),h={},u={},Q=null,se={},d={},l={},f=new WeakMap,m=[],_=null,g=!1,p=null,y=null,A=null,S=null,P=null,E=null,x=null,T=new qe(0,0,0),k=0,D=!1,N=null,z=null,H=null,I=null,W=null,ee.set(0,0,i.canvas.width,i.canvas.height),me.set(0,0,i.canvas.width,i.canvas.height),r.reset(),o.reset(),a.reset()}return{buffers:{color:r,depth:o,stencil:a},enable:Se,disable:We,bindFramebuffer:ot,drawBuffers:Ve,useProgram:mt,setBlending:Jt,setMaterial:Ht,setFlipSided:un,setCullFace:Ut,setLineWidth:En,setPolygonOffset:wt,setScissorTest:yn,activeTexture:nn,bindTexture:dn,unbindTexture:O,compressedTexImage2D:Re,compressedTexImage3D:Ze,texImage2D:b,texImage3D:q,pixelStorei:oe,getParameter:he,updateUBOMapping:te,uniformBlockBinding:ie,texStorage2D:Ye,texStorage3D:C,texSubImage2D:at,texSubImage3D:Me,compressedTexSubImage2D:Bt,compressedTexSubImage3D:ze,scissor:ve,viewport:ye,reset:pe}}function u1(i,e,t,n,s,r,o){let a=e.has("WEBGL_multisampled_render_to_texture")?e.get("WEBGL_multisampled_render_to_texture"):null,l=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new He,h=new WeakMap,u=new Set,d,f=new WeakMap,m=new Set,_=new FinalizationRegistry(C=>m.delete(C)),g=!1;try{g=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function p(C,b){return g?new OffscreenCanvas(C,b):aa("canvas")}function y(C,b,q){let he=1,oe=Ye(C);if((oe.width>q||oe.height>q)&&(he=q/Math.max(oe.width,oe.height)),he<1)if(typeof HTMLImageElement<"u"&&C instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&C instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&C instanceof ImageBitmap||typeof VideoFrame<"u"&&C instanceof VideoFrame){let ve=Math.floor(he*oe.width),ye=Math.floor(he*oe.height);d===void 0&&(d=p(ve,ye));let te=b?p(ve,ye):d;return te.width=ve,te.height=ye,te.getContext("2d").drawImage(C,0,0,ve,ye),$e("WebGLRenderer: Texture has been resized from ("+oe.width+"x"+oe.height+") to ("+ve+"x"+ye+")."),te}else return"data"in C&&$e("WebGLRenderer: Image in DataTexture is too big ("+oe.width+"x"+oe.height+")."),C;return C}function A(C){return C.generateMipmaps}function S(C){i.generateMipmap(C)}function P(C){return C.isWebGLCubeRenderTarget?i.TEXTURE_CUBE_MAP:C.isWebGL3DRenderTarget?i.TEXTURE_3D:C.isWebGLArrayRenderTarget||C.isCompressedArrayTexture?i.TEXTURE_2D_ARRAY:i.TEXTURE_2D}function E(C,b,q,he,oe,ve=!1){if(C!==null){if(i[C]!==void 0)return i[C];$e("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+C+"'")}let ye;he&&(ye=e.get("EXT_texture_norm16"),ye||$e("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let te=b;if(b===i.RED&&(q===i.FLOAT&&(te=i.R32F),q===i.HALF_FLOAT&&(te=i.R16F),q===i.UNSIGNED_BYTE&&(te=i.R8),q===i.UNSIGNED_SHORT&&ye&&(te=ye.R16_EXT),q===i.SHORT&&ye&&(te=ye.R16_SNORM_EXT)),b===i.RED_INTEGER&&(q===i.UNSIGNED_BYTE&&(te=i.R8UI),q===i.UNSIGNED_SHORT&&(te=i.R16UI),q===i.UNSIGNED_INT&&(te=i.R32UI),q===i.BYTE&&(te=i.R8I),q===i.SHORT&&(te=i.R16I),q===i.INT&&(te=i.R32I)),b===i.RG&&(q===i.FLOAT&&(te=i.RG32F),q===i.HALF_FLOAT&&(te=i.RG16F),q===i.UNSIGNED_BYTE&&(te=i.RG8),q===i.UNSIGNED_SHORT&&ye&&(te=ye.RG16_EXT),q===i.SHORT&&ye&&(te=ye.RG16_SNORM_EXT)),b===i.RG_INTEGER&&(q===i.UNSIGNED_BYTE&&(te=i.RG8UI),q===i.UNSIGNED_SHORT&&(te=i.RG16UI),q===i.UNSIGNED_INT&&(te=i.RG32UI),q===i.BYTE&&(te=i.RG8I),q===i.SHORT&&(te=i.RG16I),q===i.INT&&(te=i.RG32I)),b===i.RGB_INTEGER&&(q===i.UNSIGNED_BYTE&&(te=i.RGB8UI),q===i.UNSIGNED_SHORT&&(te=i.RGB16UI),q===i.UNSIGNED_INT&&(te=i.RGB32UI),q===i.BYTE&&(te=i.RGB8I),q===i.SHORT&&(te=i.RGB16I),q===i.INT&&(te=i.RGB32I)),b===i.RGBA_INTEGER&&(q===i.UNSIGNED_BYTE&&(te=i.RGBA8UI),q===i.UNSIGNED_SHORT&&(te=i.RGBA16UI),q===i.UNSIGNED_INT&&(te=i.RGBA32UI),q===i.BYTE&&(te=i.RGBA8I),q===i.SHORT&&(te=i.RGBA16I),q===i.INT&&(te=i.RGBA32I)),b===i.RGB&&(q===i.UNSIGNED_SHORT&&ye&&(te=ye.RGB16_EXT),q===i.SHORT&&ye&&(te=ye.RGB16_SNORM_EXT),q===i.UNSIGNED_INT_5_9_9_9_REV&&(te=i.RGB9_E5),q===i.UNSIGNED_INT_10F_11F_11F_REV&&(te=i.R11F_G11F_B10F)),b===i.RGBA){let ie=ve?oa:yt.getTransfer(oe);q===i.FLOAT&&(te=i.RGBA32F),q===i.HALF_FLOAT&&(te=i.RGBA16F),q===i.UNSIGNED_BYTE&&(te=ie===It?i.SRGB8_ALPHA8:i.RGBA8),q===i.UNSIGNED_SHORT&&ye&&(te=ye.RGBA16_EXT),q===i.SHORT&&ye&&(te=ye.RGBA16_SNORM_EXT),q===i.UNSIGNED_SHORT_4_4_4_4&&(te=i.RGBA4),q===i.UNSIGNED_SHORT_5_5_5_1&&(te=i.RGB5_A1)}return(te===i.R16F||te===i.R32F||te===i.RG16F||te===i.RG32F||te===i.RGBA16F||te===i.RGBA32F)&&e.get("EXT_color_buffer_float"),te}function x(C,b){let q;return C?b===null||b===Bi||b===Mr?q=i.DEPTH24_STENCIL8:b===Ci?q=i.DEPTH32F_STENCIL8:b===yo&&(q=i.DEPTH24_STENCIL8,$e("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):b===null||b===Bi||b===Mr?q=i.DEPTH_COMPONENT24:b===Ci?q=i.DEPTH_COMPONENT32F:b===yo&&(q=i.DEPTH_COMPONENT16),q}function T(C,b){return A(C)===!0||C.isFramebufferTexture&&C.minFilter!==In&&C.minFilter!==Kn?Math.log2(Math.max(b.width,b.height))+1:C.mipmaps.length>0?C.mipmaps.length:C.isCompressedTexture&&Array.isArray(C.image)?b.mipmaps.length:1}function k(C){let b=new WeakRef(C);n.get(C).__ref=b,m.add(b),_.register(C,b,b)}function D(C){let b=n.get(C).__ref;b!==void 0&&(m.delete(b),_.unregister(b))}function N(C){H(C.target)}function z(C){I(C.target)}function H(C){C.removeEventListener("dispose",N),D(C),$(C),C.isVideoTexture&&h.delete(C),C.isHTMLTexture&&u.delete(C)}function I(C){C.removeEventListener("dispose",z),D(C),ce(C)}function W(){for(let C of m){let b=C.deref();b!==void 0&&(b.isRenderTarget===!0?I(b):H(b))}m.clear(),u.clear()}function $(C){let b=n.get(C);if(b.__webglInit===void 0)return;let q=C.source,he=f.get(q);if(he){let oe=he[b.__cacheKey];oe.usedTimes--,oe.usedTimes===0&&G(C),Object.keys(he).length===0&&f.delete(q)}n.remove(C)}function G(C){let b=n.get(C);i.deleteTexture(b.__webglTexture);let q=C.source,he=f.get(q);delete he[b.__cacheKey],o.memory.textures--}function ce(C){let b=n.get(C);b.__depthDisposeCallback&&b.__depthDisposeCallback();let q=C.depthTexture;if(q&&q.renderTarget===C&&H(q),C.isWebGLCubeRenderTarget)for(let oe=0;oe<6;oe++){if(Array.isArray(b.__webglFramebuffer[oe]))for(let ve=0;ve<b.__webglFramebuffer[oe].length;ve++)i.deleteFramebuffer(b.__webglFramebuffer[oe][ve]);else i.deleteFramebuffer(b.__webglFramebuffer[oe]);b.__webglDepthbuffer&&i.deleteRenderbuffer(b.__webglDepthbuffer[oe])}else{if(Array.isArray(b.__webglFramebuffer))for(let oe=0;oe<b.__webglFramebuffer.length;oe++)i.deleteFramebuffer(b.__webglFramebuffer[oe]);else i.deleteFramebuffer(b.__webglFramebuffer);if(b.__webglDepthbuffer&&i.deleteRenderbuffer(b.__webglDepthbuffer),b.__webglMultisampledFramebuffer&&i.deleteFramebuffer(b.__webglMultisampledFramebuffer),b.__webglColorRenderbuffer)for(let oe=0;oe<b.__webglColorRenderbuffer.length;oe++)b.__webglColorRenderbuffer[oe]&&i.deleteRenderbuffer(b.__webglColorRenderbuffer[oe]);b.__webglDepthRenderbuffer&&i.deleteRenderbuffer(b.__webglDepthRenderbuffer)}let he=C.textures;for(let oe=0,ve=he.length;oe<ve;oe++){let ye=n.get(he[oe]);ye.__webglTexture&&(i.deleteTexture(ye.__webglTexture),o.memory.textures--),n.remove(he[oe])}n.remove(C)}let J=0;function Q(){J=0}function se(){return J}function de(C){J=C}function ue(){let C=J;return C>=s.maxTextures&&$e("WebGLTextures: Trying to use "+(C+1)+" texture units while this GPU supports only "+s.maxTextures),J+=1,C}function ee(C){let b=[];return b.push(C.wrapS),b.push(C.wrapT),b.push(C.wrapR||0),b.push(C.magFilter),b.push(C.minFilter),b.push(C.anisotropy),b.push(C.internalFormat),b.push(C.format),b.push(C.type),b.push(C.generateMipmaps),b.push(C.mipmapsAutoUpdate),b.push(C.premultiplyAlpha),b.push(C.flipY),b.push(C.unpackAlignment),b.push(C.colorSpace),b.join()}function me(C,b){let q=n.get(C);if(C.isVideoTexture&&Bt(C),C.isRenderTargetTexture===!1&&C.isExternalTexture!==!0&&C.version>0&&q.__version!==C.version){let he=C.image;if(he===null)$e("WebGLRenderer: Texture marked for update but no image data found.");else if(he.complete===!1)$e("WebGLRenderer: Texture marked for update but image is incomplete");else{Ht(q,C,b);return}}else C.isExternalTexture&&(q.__webglTexture=C.sourceTexture?C.sourceTexture:null);t.bindTexture(i.TEXTURE_2D,q.__webglTexture,i.TEXTURE0+b)}function xe(C,b){let q=n.get(C);if(C.isRenderTargetTexture===!1&&C.version>0&&q.__version!==C.version){Ht(q,C,b);return}else C.isExternalTexture&&(q.__webglTexture=C.sourceTexture?C.sourceTexture:null);t.bindTexture(i.TEXTURE_2D_ARRAY,q.__webglTexture,i.TEXTURE0+b)}function Ae(C,b){let q=n.get(C);if(C.isRenderTargetTexture===!1&&C.version>0&&q.__version!==C.version){Ht(q,C,b);return}t.bindTexture(i.TEXTURE_3D,q.__webglTexture,i.TEXTURE0+b)}function Se(C,b){let q=n.get(C);if(C.version>0&&q.__version!==C.version){un(q,C,b);return}t.bindTexture(i.TEXTURE_CUBE_MAP,q.__webglTexture,i.TEXTURE0+b)}let We={[Jl]:i.REPEAT,[ts]:i.CLAMP_TO_EDGE,[jl]:i.MIRRORED_REPEAT},ot={[In]:i.NEAREST,[ag]:i.NEAREST_MIPMAP_NEAREST,[Ra]:i.NEAREST_MIPMAP_LINEAR,[Kn]:i.LINEAR,[wc]:i.LINEAR_MIPMAP_NEAREST,[Ps]:i.LINEAR_MIPMAP_LINEAR},Ve={[ug]:i.NEVER,[af]:i.ALWAYS,[dg]:i.LESS,[rf]:i.LEQUAL,[fg]:i.EQUAL,[of]:i.GEQUAL,[pg]:i.GREATER,[mg]:i.NOTEQUAL};function mt(C,b){if(b.type===Ci&&e.has("OES_texture_float_linear")===!1&&(b.magFilter===Kn||b.magFilter===wc||b.magFilter===Ra||b.magFilter===Ps||b.minFilter===Kn||b.minFilter===wc||b.minFilter===Ra||b.minFilter===Ps)&&$e("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),i.texParameteri(C,i.TEXTURE_WRAP_S,We[b.wrapS]),i.texParameteri(C,i.TEXTURE_WRAP_T,We[b.wrapT]),(C===i.TEXTURE_3D||C===i.TEXTURE_2D_ARRAY)&&i.texParameteri(C,i.TEXTURE_WRAP_R,We[b.wrapR]),i.texParameteri(C,i.TEXTURE_MAG_FILTER,ot[b.magFilter]),i.texParameteri(C,i.TEXTURE_MIN_FILTER,ot[b.minFilter]),b.compareFunction&&(i.texParameteri(C,i.TEXTURE_COMPARE_MODE,i.COMPARE_REF_TO_TEXTURE),i.texParameteri(C,i.TEXTURE_COMPARE_FUNC,Ve[b.compareFunction])),e.has("EXT_texture_filter_anisotropic")===!0){if(b.magFilter===In||b.minFilter!==Ra&&b.minFilter!==Ps||b.type===Ci&&e.has("OES_texture_float_linear")===!1)return;if(b.anisotropy>1||n.get(b).__currentAnisotropy){let q=e.get("EXT_texture_filter_anisotropic");i.texParameterf(C,q.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(b.anisotropy,s.getMaxAnisotropy())),n.get(b).__currentAnisotropy=b.anisotropy}}}function ht(C,b){let q=!1;C.__webglInit===void 0&&(C.__webglInit=!0,b.addEventListener("dispose",N),k(b));let he=b.source,oe=f.get(he);oe===void 0&&(oe={},f.set(he,oe));let ve=ee(b);if(ve!==C.__cacheKey){oe[ve]===void 0&&(oe[ve]={texture:i.createTexture(),usedTimes:0},o.memory.textures++,q=!0),oe[ve].usedTimes++;let ye=oe[C.__cacheKey];ye!==void 0&&(oe[C.__cacheKey].usedTimes--,ye.usedTimes===0&&G(b)),C.__cacheKey=ve,C.__webglTexture=oe[ve].texture}return q}function st(C,b,q){return Math.floor(Math.floor(C/q)/b)}function Jt(C,b,q,he){let ve=C.updateRanges;if(ve.length===0)t.texSubImage2D(i.TEXTURE_2D,0,0,0,b.width,b.height,q,he,b.data);else{ve.sort((F,re)=>F.start-re.start);let ye=0;for(let F=1;F<ve.length;F++){let re=ve[ye],ne=ve[F],we=re.start+re.count,ge=st(ne.start,b.width,4),be=st(re.start,b.width,4);ne.start<=we+1&&ge===be&&st(ne.start+ne.count-1,b.width,4)===ge?re.count=Math.max(re.count,ne.start+ne.count-re.start):(++ye,ve[ye]=ne)}ve.length=ye+1;let te=t.getParameter(i.UNPACK_ROW_LENGTH),ie=t.getParameter(i.UNPACK_SKIP_PIXELS),pe=t.getParameter(i.UNPACK_SKIP_ROWS);t.pixelStorei(i.UNPACK_ROW_LENGTH,b.width);for(let F=0,re=ve.length;F<re;F++){let ne=ve[F],we=Math.floor(ne.start/4),ge=Math.ceil(ne.count/4),be=we%b.width,Ge=Math.floor(we/b.width),je=ge,le=1;t.pixelStorei(i.UNPACK_SKIP_PIXELS,be),t.pixelStorei(i.UNPACK_SKIP_ROWS,Ge),t.texSubImage2D(i.TEXTURE_2D,0,be,Ge,je,le,q,he,b.data)}C.clearUpdateRanges(),t.pixelStorei(i.UNPACK_ROW_LENGTH,te),t.pixelStorei(i.UNPACK_SKIP_PIXELS,ie),t.pixelStorei(i.UNPACK_SKIP_ROWS,pe)}}function Ht(C,b,q){let he=i.TEXTURE_2D;(b.isDataArrayTexture||b.isCompressedArrayTexture)&&(he=i.TEXTURE_2D_ARRAY),b.isData3DTexture&&(he=i.TEXTURE_3D);let oe=ht(C,b),ve=b.source;t.bindTexture(he,C.__webglTexture,i.TEXTURE0+q);let ye=n.get(ve);if(ve.version!==ye.__version||oe===!0){if(t.activeTexture(i.TEXTURE0+q),(typeof ImageBitmap<"u"&&b.image instanceof ImageBitmap)===!1){let le=yt.getPrimaries(yt.workingColorSpace),Ue=b.colorSpace===Is?null:yt.getPrimaries(b.colorSpace),Qe=b.colorSpace===Is||le===Ue?i.NONE:i.BROWSER_DEFAULT_WEBGL;t.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,b.flipY),t.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,b.premultiplyAlpha),t.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,Qe)}t.pixelStorei(i.UNPACK_ALIGNMENT,b.unpackAlignment);let ie=y(b.image,!1,s.maxTextureSize);ie=ze(b,ie);let pe=r.convert(b.format,b.colorSpace),F=r.convert(b.type),re=E(b.internalFormat,pe,F,b.normalized,b.colorSpace,b.isVideoTexture);mt(he,b);let ne,we=b.mipmaps,ge=b.isVideoTexture!==!0,be=ye.__version===void 0||oe===!0,Ge=ve.dataReady,je=T(b,ie);if(b.isDepthTexture)re=x(b.format===Ls,b.type),be&&(ge?t.texStorage2D(i.TEXTURE_2D,1,re,ie.width,ie.height):t.texImage2D(i.TEXTURE_2D,0,re,ie.width,ie.height,0,pe,F,null));else if(b.isDataTexture)if(we.length>0){ge&&be&&t.texStorage2D(i.TEXTURE_2D,je,re,we[0].width,we[0].height);for(let le=0,Ue=we.length;le<Ue;le++)ne=we[le],ge?Ge&&t.texSubImage2D(i.TEXTURE_2D,le,0,0,ne.width,ne.height,pe,F,ne.data):t.texImage2D(i.TEXTURE_2D,le,re,ne.width,ne.height,0,pe,F,ne.data);b.generateMipmaps=!1}else ge?(be&&t.texStorage2D(i.TEXTURE_2D,je,re,ie.width,ie.height),Ge&&Jt(b,ie,pe,F)):t.texImage2D(i.TEXTURE_2D,0,re,ie.width,ie.height,0,pe,F,ie.data);else if(b.isCompressedTexture)if(b.isCompressedArrayTexture){ge&&be&&t.texStorage3D(i.TEXTURE_2D_ARRAY,je,re,we[0].width,we[0].height,ie.depth);for(let le=0,Ue=we.length;le<Ue;le++)if(ne=we[le],b.format!==Vi)if(pe!==null)if(ge){if(Ge)if(b.layerUpdates.size>0){let Qe=gf(ne.width,ne.height,b.format,b.type);for(let Ce of b.layerUpdates){let lt=ne.data.subarray(Ce*Qe/ne.data.BYTES_PER_ELEMENT,(Ce+1)*Qe/ne.data.BYTES_PER_ELEMENT);t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,le,0,0,Ce,ne.width,ne.height,1,pe,lt)}}else t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,le,0,0,0,ne.width,ne.height,ie.depth,pe,ne.data)}else t.compressedTexImage3D(i.TEXTURE_2D_ARRAY,le,re,ne.width,ne.height,ie.depth,0,ne.data,0,0);else $e("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else ge?Ge&&t.texSubImage3D(i.TEXTURE_2D_ARRAY,le,0,0,0,ne.width,ne.height,ie.depth,pe,F,ne.data):t.texImage3D(i.TEXTURE_2D_ARRAY,le,re,ne.width,ne.height,ie.depth,0,pe,F,ne.data);b.layerUpdates.size>0&&b.clearLayerUpdates()}else{ge&&be&&t.texStorage2D(i.TEXTURE_2D,je,re,we[0].width,we[0].height);for(let le=0,Ue=we.length;le<Ue;le++)ne=we[le],b.format!==Vi?pe!==null?ge?Ge&&t.compressedTexSubImage2D(i.TEXTURE_2D,le,0,0,ne.width,ne.height,pe,ne.data):t.compressedTexImage2D(i.TEXTURE_2D,le,re,ne.width,ne.height,0,ne.data):$e("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):ge?Ge&&t.texSubImage2D(i.TEXTURE_2D,le,0,0,ne.width,ne.height,pe,F,ne.data):t.texImage2D(i.TEXTURE_2D,le,re,ne.width,ne.height,0,pe,F,ne.data)}else if(b.isDataArrayTexture)if(ge){if(be&&t.texStorage3D(i.TEXTURE_2D_ARRAY,je,re,ie.width,ie.height,ie.depth),Ge)if(b.layerUpdates.size>0){let le=gf(ie.width,ie.height,b.format,b.type);for(let Ue of b.layerUpdates){let Qe=ie.data.subarray(Ue*le/ie.data.BYTES_PER_ELEMENT,(Ue+1)*le/ie.data.BYTES_PER_ELEMENT);t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,Ue,ie.width,ie.height,1,pe,F,Qe)}b.clearLayerUpdates()}else t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,0,ie.width,ie.height,ie.depth,pe,F,ie.data)}else t.texImage3D(i.TEXTURE_2D_ARRAY,0,re,ie.width,ie.height,ie.depth,0,pe,F,ie.data);else if(b.isData3DTexture)ge?(be&&t.texStorage3D(i.TEXTURE_3D,je,re,ie.width,ie.height,ie.depth),Ge&&t.texSubImage3D(i.TEXTURE_3D,0,0,0,0,ie.width,ie.height,ie.depth,pe,F,ie.data)):t.texImage3D(i.TEXTURE_3D,0,re,ie.width,ie.height,ie.depth,0,pe,F,ie.data);else if(b.isFramebufferTexture){if(be)if(ge)t.texStorage2D(i.TEXTURE_2D,je,re,ie.width,ie.height);else{let le=ie.width,Ue=ie.height;for(let Qe=0;Qe<je;Qe++)t.texImage2D(i.TEXTURE_2D,Qe,re,le,Ue,0,pe,F,null),le>>=1,Ue>>=1}}else if(b.isHTMLTexture){if("texElementImage2D"in i){let le=i.canvas;if(le.hasAttribute("layoutsubtree")||le.setAttribute("layoutsubtree","true"),ie.parentNode!==le){le.appendChild(ie),u.add(b),le.onpaint=Ue=>{let Qe=Ue.changedElements;for(let Ce of u)Qe.includes(Ce.image)&&(Ce.needsUpdate=!0)},le.requestPaint();return}if(i.texElementImage2D.length===3)i.texElementImage2D(i.TEXTURE_2D,i.RGBA8,ie);else{let Qe=i.RGBA,Ce=i.RGBA,lt=i.UNSIGNED_BYTE;i.texElementImage2D(i.TEXTURE_2D,0,Qe,Ce,lt,ie)}i.texParameteri(i.TEXTURE_2D,i.TEXTURE_MIN_FILTER,i.LINEAR),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_S,i.CLAMP_TO_EDGE),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_T,i.CLAMP_TO_EDGE)}}else if(we.length>0){if(ge&&be){let le=Ye(we[0]);t.texStorage2D(i.TEXTURE_2D,je,re,le.width,le.height)}for(let le=0,Ue=we.length;le<Ue;le++)ne=we[le],ge?Ge&&t.texSubImage2D(i.TEXTURE_2D,le,0,0,pe,F,ne):t.texImage2D(i.TEXTURE_2D,le,re,pe,F,ne);b.generateMipmaps=!1}else if(ge){if(be){let le=Ye(ie);t.texStorage2D(i.TEXTURE_2D,je,re,le.width,le.height)}Ge&&t.texSubImage2D(i.TEXTURE_2D,0,0,0,pe,F,ie)}else t.texImage2D(i.TEXTURE_2D,0,re,pe,F,ie);A(b)&&b.mipmapsAutoUpdate===!0&&S(he),ye.__version=ve.version,b.onUpdate&&b.onUpdate(b)}C.__version=b.version}function un(C,b,q){if(b.image.length!==6)return;let he=ht(C,b),oe=b.source;t.bindTexture(i.TEXTURE_CUBE_MAP,C.__webglTexture,i.TEXTURE0+q);let ve=n.get(oe);if(oe.version!==ve.__version||he===!0){t.activeTexture(i.TEXTURE0+q);let ye=yt.getPrimaries(yt.workingColorSpace),te=b.colorSpace===Is?null:yt.getPrimaries(b.colorSpace),ie=b.colorSpace===Is||ye===te?i.NONE:i.BROWSER_DEFAULT_WEBGL;t.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,b.flipY),t.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,b.premultiplyAlpha),t.pixelStorei(i.UNPACK_ALIGNMENT,b.unpackAlignment),t.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,ie);let pe=b.isCompressedTexture||b.image[0].isCompressedTexture,F=b.image[0]&&b.image[0].isDataTexture,re=[];for(let Ce=0;Ce<6;Ce++)!pe&&!F?re[Ce]=y(b.image[Ce],!0,s.maxCubemapSize):re[Ce]=F?b.image[Ce].image:b.image[Ce],re[Ce]=ze(b,re[Ce]);let ne=re[0],we=r.convert(b.format,b.colorSpace),ge=r.convert(b.type),be=E(b.internalFormat,we,ge,b.normalized,b.colorSpace),Ge=b.isVideoTexture!==!0,je=ve.__version===void 0||he===!0,le=oe.dataReady,Ue=T(b,ne);mt(i.TEXTURE_CUBE_MAP,b);let Qe;if(b.isDepthTexture){if(be=x(b.format===Ls,b.type),je)if(Ge)t.texStorage2D(i.TEXTURE_CUBE_MAP,1,be,ne.width,ne.height);else for(let Ce=0;Ce<6;Ce++)t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,be,ne.width,ne.height,0,we,ge,null)}else if(pe){Ge&&je&&t.texStorage2D(i.TEXTURE_CUBE_MAP,Ue,be,ne.width,ne.height);for(let Ce=0;Ce<6;Ce++){Qe=re[Ce].mipmaps;for(let lt=0;lt<Qe.length;lt++){let Wt=Qe[lt];b.format!==Vi?we!==null?Ge?le&&t.compressedTexSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,lt,0,0,Wt.width,Wt.height,we,Wt.data):t.compressedTexImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,lt,be,Wt.width,Wt.height,0,Wt.data):$e("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):Ge?le&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,lt,0,0,Wt.width,Wt.height,we,ge,Wt.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,lt,be,Wt.width,Wt.height,0,we,ge,Wt.data)}}}else{if(Qe=b.mipmaps,Ge&&je){Qe.length>0&&Ue++;let Ce=Ye(re[0]);t.texStorage2D(i.TEXTURE_CUBE_MAP,Ue,be,Ce.width,Ce.height)}for(let Ce=0;Ce<6;Ce++)if(F){Ge?le&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,0,0,re[Ce].width,re[Ce].height,we,ge,re[Ce].data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,be,re[Ce].width,re[Ce].height,0,we,ge,re[Ce].data);for(let lt=0;lt<Qe.length;lt++){let Hn=Qe[lt].image[Ce].image;Ge?le&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,lt+1,0,0,Hn.width,Hn.height,we,ge,Hn.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,lt+1,be,Hn.width,Hn.height,0,we,ge,Hn.data)}}else{Ge?le&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,0,0,we,ge,re[Ce]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,be,we,ge,re[Ce]);for(let lt=0;lt<Qe.length;lt++){let Wt=Qe[lt];Ge?le&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,lt+1,0,0,we,ge,Wt.image[Ce]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,lt+1,be,we,ge,Wt.image[Ce])}}}A(b)&&b.mipmapsAutoUpdate===!0&&S(i.TEXTURE_CUBE_MAP),ve.__version=oe.version,b.onUpdate&&b.onUpdate(b)}C.__version=b.version}function Ut(C,b,q,he,oe,ve){let ye=r.convert(q.format,q.colorSpace),te=r.convert(q.type),ie=E(q.internalFormat,ye,te,q.normalized,q.colorSpace),pe=n.get(b),F=n.get(q);if(F.__renderTarget=b,!pe.__hasExternalTextures){let re=Math.max(1,b.width>>ve),ne=Math.max(1,b.height>>ve);oe===i.TEXTURE_3D||oe===i.TEXTURE_2D_ARRAY?t.texImage3D(oe,ve,ie,re,ne,b.depth,0,ye,te,null):t.texImage2D(oe,ve,ie,re,ne,0,ye,te,null)}t.bindFramebuffer(i.FRAMEBUFFER,C),Me(b)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,he,oe,F.__webglTexture,0,at(b)):(oe===i.TEXTURE_2D||oe>=i.TEXTURE_CUBE_MAP_POSITIVE_X&&oe<=i.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&i.framebufferTexture2D(i.FRAMEBUFFER,he,oe,F.__webglTexture,ve),t.bindFramebuffer(i.FRAMEBUFFER,null)}function En(C,b,q){if(i.bindRenderbuffer(i.RENDERBUFFER,C),b.depthBuffer){let he=b.depthTexture,oe=he&&he.isDepthTexture?he.type:null,ve=x(b.stencilBuffer,oe),ye=b.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;Me(b)?a.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,at(b),ve,b.width,b.height):q?i.renderbufferStorageMultisample(i.RENDERBUFFER,at(b),ve,b.width,b.height):i.renderbufferStorage(i.RENDERBUFFER,ve,b.width,b.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,ye,i.RENDERBUFFER,C)}else{let he=b.textures;for(let oe=0;oe<he.length;oe++){let ve=he[oe],ye=r.convert(ve.format,ve.colorSpace),te=r.convert(ve.type),ie=E(ve.internalFormat,ye,te,ve.normalized,ve.colorSpace);Me(b)?a.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,at(b),ie,b.width,b.height):q?i.renderbufferStorageMultisample(i.RENDERBUFFER,at(b),ie,b.width,b.height):i.renderbufferStorage(i.RENDERBUFFER,ie,b.width,b.height)}}i.bindRenderbuffer(i.RENDERBUFFER,null)}function wt(C,b,q){let he=b.isWebGLCubeRenderTarget===!0;if(t.bindFramebuffer(i.FRAMEBUFFER,C),!(b.depthTexture&&b.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");let oe=n.get(b.depthTexture);oe.__renderTarget=b;let ve=he?b.depthTexture.image[0]:b.depthTexture.image;(!oe.__webglTexture||ve.width!==b.width||ve.height!==b.height)&&(ve.width=b.width,ve.height=b.height,b.depthTexture.needsUpdate=!0),he?Se(b.depthTexture,0):me(b.depthTexture,0);let ye=oe.__webglTexture,te=at(b),ie=he?i.TEXTURE_CUBE_MAP_POSITIVE_X+q:i.TEXTURE_2D,pe=b.depthTexture.format===Ls?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;if(b.depthTexture.format===Es)Me(b)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,pe,ie,ye,0,te):i.framebufferTexture2D(i.FRAMEBUFFER,pe,ie,ye,0);else if(b.depthTexture.format===Ls)Me(b)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,pe,ie,ye,0,te):i.framebufferTexture2D(i.FRAMEBUFFER,pe,ie,ye,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function yn(C){let b=n.get(C),q=C.isWebGLCubeRenderTarget===!0;if(b.__boundDepthTexture!==C.depthTexture){let he=C.depthTexture;if(b.__depthDisposeCallback&&b.__depthDisposeCallback(),he){let oe=()=>{delete b.__boundDepthTexture,delete b.__depthDisposeCallback,he.removeEventListener("dispose",oe)};he.addEventListener("dispose",oe),b.__depthDisposeCallback=oe}b.__boundDepthTexture=he}if(C.depthTexture&&!b.__autoAllocateDepthBuffer)if(q)for(let he=0;he<6;he++)wt(b.__webglFramebuffer[he],C,he);else C.texture.mipmaps.length>0?wt(b.__webglFramebuffer[0],C,0):wt(b.__webglFramebuffer,C,0);else if(q){b.__webglDepthbuffer=[];for(let he=0;he<6;he++)if(t.bindFramebuffer(i.FRAMEBUFFER,b.__webglFramebuffer[he]),b.__webglDepthbuffer[he]===void 0)b.__webglDepthbuffer[he]=i.createRenderbuffer(),En(b.__webglDepthbuffer[he],C,!1);else{let oe=C.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,ve=b.__webglDepthbuffer[he];i.bindRenderbuffer(i.RENDERBUFFER,ve),i.framebufferRenderbuffer(i.FRAMEBUFFER,oe,i.RENDERBUFFER,ve)}}else if(C.texture.mipmaps.length>0?t.bindFramebuffer(i.FRAMEBUFFER,b.__webglFramebuffer[0]):t.bindFramebuffer(i.FRAMEBUFFER,b.__webglFramebuffer),b.__webglDepthbuffer===void 0)b.__webglDepthbuffer=i.createRenderbuffer(),En(b.__webglDepthbuffer,C,!1);else{let oe=C.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,ve=b.__webglDepthbuffer;i.bindRenderbuffer(i.RENDERBUFFER,ve),i.framebufferRenderbuffer(i.FRAMEBUFFER,oe,i.RENDERBUFFER,ve)}t.bindFramebuffer(i.FRAMEBUFFER,null)}function nn(C,b,q){let he=n.get(C);b!==void 0&&Ut(he.__webglFramebuffer,C,C.texture,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,0),q!==void 0&&yn(C)}function dn(C){let b=C.texture,q=n.get(C),he=n.get(b);C.addEventListener("dispose",z),k(C);let oe=C.textures,ve=C.isWebGLCubeRenderTarget===!0,ye=oe.length>1;if(ye||(he.__webglTexture===void 0&&(he.__webglTexture=i.createTexture()),he.__version=b.version,o.memory.textures++),ve){q.__webglFramebuffer=[];for(let te=0;te<6;te++)if(b.mipmaps.length>0){q.__webglFramebuffer[te]=[];for(let ie=0;ie<b.mipmaps.length;ie++)q.__webglFramebuffer[te][ie]=i.createFramebuffer()}else q.__webglFramebuffer[te]=i.createFramebuffer()}else{if(b.mipmaps.length>0){q.__webglFramebuffer=[];for(let te=0;te<b.mipmaps.length;te++)q.__webglFramebuffer[te]=i.createFramebuffer()}else q.__webglFramebuffer=i.createFramebuffer();if(ye)for(let te=0,ie=oe.length;te<ie;te++){let pe=n.get(oe[te]);pe.__webglTexture===void 0&&(pe.__webglTexture=i.createTexture(),o.memory.textures++)}if(C.samples>0&&Me(C)===!1){q.__webglMultisampledFramebuffer=i.createFramebuffer(),q.__webglColorRenderbuffer=[],t.bindFramebuffer(i.FRAMEBUFFER,q.__webglMultisampledFramebuffer);for(let te=0;te<oe.length;te++){let ie=oe[te];q.__webglColorRenderbuffer[te]=i.createRenderbuffer(),i.bindRenderbuffer(i.RENDERBUFFER,q.__webglColorRenderbuffer[te]);let pe=r.convert(ie.format,ie.colorSpace),F=r.convert(ie.type),re=E(ie.internalFormat,pe,F,ie.normalized,ie.colorSpace,C.isXRRenderTarget===!0),ne=at(C);i.renderbufferStorageMultisample(i.RENDERBUFFER,ne,re,C.width,C.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+te,i.RENDERBUFFER,q.__webglColorRenderbuffer[te])}i.bindRenderbuffer(i.RENDERBUFFER,null),C.depthBuffer&&(q.__webglDepthRenderbuffer=i.createRenderbuffer(),En(q.__webglDepthRenderbuffer,C,!0)),t.bindFramebuffer(i.FRAMEBUFFER,null)}}if(ve){t.bindTexture(i.TEXTURE_CUBE_MAP,he.__webglTexture),mt(i.TEXTURE_CUBE_MAP,b);for(let te=0;te<6;te++)if(b.mipmaps.length>0)for(let ie=0;ie<b.mipmaps.length;ie++)Ut(q.__webglFramebuffer[te][ie],C,b,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+te,ie);else Ut(q.__webglFramebuffer[te],C,b,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+te,0);A(b)?S(i.TEXTURE_CUBE_MAP):b.mipmaps.length>0&&i.texParameteri(i.TEXTURE_CUBE_MAP,i.TEXTURE_MAX_LEVEL,b.mipmaps.length-1),t.unbindTexture()}else if(ye){for(let te=0,ie=oe.length;te<ie;te++){let pe=oe[te],F=n.get(pe),re=i.TEXTURE_2D;(C.isWebGL3DRenderTarget||C.isWebGLArrayRenderTarget)&&(re=C.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(re,F.__webglTexture),mt(re,pe),Ut(q.__webglFramebuffer,C,pe,i.COLOR_ATTACHMENT0+te,re,0),A(pe)&&S(re)}t.unbindTexture()}else{let te=i.TEXTURE_2D;if((C.isWebGL3DRenderTarget||C.isWebGLArrayRenderTarget)&&(te=C.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(te,he.__webglTexture),mt(te,b),b.mipmaps.length>0)for(let ie=0;ie<b.mipmaps.length;ie++)Ut(q.__webglFramebuffer[ie],C,b,i.COLOR_ATTACHMENT0,te,ie);else Ut(q.__webglFramebuffer,C,b,i.COLOR_ATTACHMENT0,te,0);A(b)?S(te):b.mipmaps.length>0&&i.texParameteri(te,i.TEXTURE_MAX_LEVEL,b.mipmaps.length-1),t.unbindTexture()}C.depthBuffer&&yn(C)}function O(C){let b=C.textures;for(let q=0,he=b.length;q<he;q++){let oe=b[q];if(A(oe)&&oe.mipmapsAutoUpdate===!0){let ve=P(C),ye=n.get(oe).__webglTexture;t.bindTexture(ve,ye),S(ve),t.unbindTexture()}}}let Re=[];function Ze(C){if(C.samples>0){if(Me(C)===!1){let b=C.textures,q=C.width,he=C.height,oe=i.COLOR_BUFFER_BIT,ve=C.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,ye=n.get(C),te=b.length>1;if(te)for(let pe=0;pe<b.length;pe++)t.bindFramebuffer(i.FRAMEBUFFER,ye.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+pe,i.RENDERBUFFER,null),t.bindFramebuffer(i.FRAMEBUFFER,ye.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+pe,i.TEXTURE_2D,null,0);t.bindFramebuffer(i.READ_FRAMEBUFFER,ye.__webglMultisampledFramebuffer),C.texture.mipmaps.length>0?t.bindFramebuffer(i.DRAW_FRAMEBUFFER,ye.__webglFramebuffer[0]):t.bindFramebuffer(i.DRAW_FRAMEBUFFER,ye.__webglFramebuffer);for(let pe=0;pe<b.length;pe++){if(C.resolveDepthBuffer&&(C.depthBuffer&&(oe|=i.DEPTH_BUFFER_BIT),C.stencilBuffer&&C.resolveStencilBuffer&&(oe|=i.STENCIL_BUFFER_BIT)),te){i.framebufferRenderbuffer(i.READ_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.RENDERBUFFER,ye.__webglColorRenderbuffer[pe]);let F=n.get(b[pe]).__webglTexture;i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,F,0)}i.blitFramebuffer(0,0,q,he,0,0,q,he,oe,i.NEAREST),l===!0&&(Re.length=0,Re.push(i.COLOR_ATTACHMENT0+pe),C.depthBuffer&&C.storeMultisampledDepthBuffer===!1&&Re.push(ve),i.invalidateFramebuffer(i.READ_FRAMEBUFFER,Re))}if(t.bindFramebuffer(i.READ_FRAMEBUFFER,null),t.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),te)for(let pe=0;pe<b.length;pe++){t.bindFramebuffer(i.FRAMEBUFFER,ye.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+pe,i.RENDERBUFFER,ye.__webglColorRenderbuffer[pe]);let F=n.get(b[pe]).__webglTexture;t.bindFramebuffer(i.FRAMEBUFFER,ye.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+pe,i.TEXTURE_2D,F,0)}t.bindFramebuffer(i.DRAW_FRAMEBUFFER,ye.__webglMultisampledFramebuffer)}else if(C.depthBuffer&&C.storeMultisampledDepthBuffer===!1&&l){let b=C.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,[b])}}}function at(C){return Math.min(s.maxSamples,C.samples)}function Me(C){let b=n.get(C);return C.samples>0&&e.has("WEBGL_multisampled_render_to_texture")===!0&&b.__useRenderToTexture!==!1}function Bt(C){let b=o.render.frame;h.get(C)!==b&&(h.set(C,b),C.update())}function ze(C,b){let q=C.colorSpace,he=C.format,oe=C.type;return C.isCompressedTexture===!0||C.isVideoTexture===!0||q!==mr&&q!==Is&&(yt.getTransfer(q)===It?(he!==Vi||oe!==ni)&&$e("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):nt("WebGLTextures: Unsupported texture color space:",q)),b}function Ye(C){return typeof HTMLImageElement<"u"&&C instanceof HTMLImageElement?(c.width=C.naturalWidth||C.width,c.height=C.naturalHeight||C.height):typeof VideoFrame<"u"&&C instanceof VideoFrame?(c.width=C.displayWidth,c.height=C.displayHeight):(c.width=C.width,c.height=C.height),c}this.allocateTextureUnit=ue,this.resetTextureUnits=Q,this.getTextureUnits=se,this.setTextureUnits=de,this.setTexture2D=me,this.setTexture2DArray=xe,this.setTexture3D=Ae,this.setTextureCube=Se,this.rebindTextures=nn,this.setupRenderTarget=dn,this.updateRenderTargetMipmap=O,this.updateMultisampleRenderTarget=Ze,this.setupDepthRenderbuffer=yn,this.setupFrameBufferTexture=Ut,this.useMultisampledRTT=Me,this.dispose=W}function d1(i,e){function t(n,s=Is){let r,o=yt.getTransfer(s);if(n===ni)return i.UNSIGNED_BYTE;if(n===Ec)return i.UNSIGNED_SHORT_4_4_4_4;if(n===Ac)return i.UNSIGNED_SHORT_5_5_5_1;if(n===ef)return i.UNSIGNED_INT_5_9_9_9_REV;if(n===tf)return i.UNSIGNED_INT_10F_11F_11F_REV;if(n===jd)return i.BYTE;if(n===Qd)return i.SHORT;if(n===yo)return i.UNSIGNED_SHORT;if(n===Tc)return i.INT;if(n===Bi)return i.UNSIGNED_INT;if(n===Ci)return i.FLOAT;if(n===zi)return i.HALF_FLOAT;if(n===nf)return i.ALPHA;if(n===sf)return i.RGB;if(n===Vi)return i.RGBA;if(n===Es)return i.DEPTH_COMPONENT;if(n===Ls)return i.DEPTH_STENCIL;if(n===Cc)return i.RED;if(n===Rc)return i.RED_INTEGER;if(n===er)return i.RG;if(n===Pc)return i.RG_INTEGER;if(n===Lc)return i.RGBA_INTEGER;if(n===Pa||n===La||n===Ia||n===Na)if(o===It)if(r=e.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(n===Pa)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===La)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===Ia)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===Na)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=e.get("WEBGL_compressed_texture_s3tc"),r!==null){if(n===Pa)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===La)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===Ia)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===Na)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(n===Ic||n===Nc||n===Dc||n===Fc)if(r=e.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(n===Ic)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===Nc)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===Dc)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===Fc)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(n===Oc||n===Uc||n===kc||n===Bc||n===zc||n===Da||n===Vc)if(r=e.get("WEBGL_compressed_texture_etc"),r!==null){if(n===Oc||n===Uc)return o===It?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(n===kc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC;if(n===Bc)return r.COMPRESSED_R11_EAC;if(n===zc)return r.COMPRESSED_SIGNED_R11_EAC;if(n===Da)return r.COMPRESSED_RG11_EAC;if(n===Vc)return r.COMPRESSED_SIGNED_RG11_EAC}else return null;if(n===Gc||n===Hc||n===Wc||n===Xc||n===qc||n===Yc||n===$c||n===Zc||n===Kc||n===Jc||n===jc||n===Qc||n===eh||n===th)if(r=e.get("WEBGL_compressed_texture_astc"),r!==null){if(n===Gc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===Hc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===Wc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===Xc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===qc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===Yc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===$c)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===Zc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===Kc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===Jc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===jc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===Qc)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===eh)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===th)return o===It?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(n===nh||n===ih||n===sh)if(r=e.get("EXT_texture_compression_bptc"),r!==null){if(n===nh)return o===It?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===ih)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===sh)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(n===rh||n===oh||n===Fa||n===ah)if(r=e.get("EXT_texture_compression_rgtc"),r!==null){if(n===rh)return r.COMPRESSED_RED_RGTC1_EXT;if(n===oh)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===Fa)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===ah)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return n===Mr?i.UNSIGNED_INT_24_8:i[n]!==void 0?i[n]:null}return{convert:t}}var f1=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,p1=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,Tf=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let n=new xa(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=n}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,n=new as({vertexShader:f1,fragmentShader:p1,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new ct(new xr(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},Ef=class extends ki{constructor(e,t){super();let n=this,s=null,r=1,o=null,a="local-floor",l=1,c=null,h=null,u=null,d=null,f=null,m=null,_=typeof XRWebGLBinding<"u",g=new Tf,p={},y=t.getContextAttributes(),A=null,S=null,P=[],E=[],x=new He,T=null,k=null,D=new Zn;D.viewport=new en;let N=new Zn;N.viewport=new en;let z=[D,N],H=new _c,I=null,W=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(ee){let me=P[ee];return me===void 0&&(me=new uo,P[ee]=me),me.getTargetRaySpace()},this.getControllerGrip=function(ee){let me=P[ee];return me===void 0&&(me=new uo,P[ee]=me),me.getGripSpace()},this.getHand=function(ee){let me=P[ee];return me===void 0&&(me=new uo,P[ee]=me),me.getHandSpace()};function $(ee){let me=E.indexOf(ee.inputSource);if(me===-1)return;let xe=P[me];xe!==void 0&&(xe.update(ee.inputSource,ee.frame,c||o),xe.dispatchEvent({type:ee.type,data:ee.inputSource}))}function G(){s.removeEventListener("select",$),s.removeEventListener("selectstart",$),s.removeEventListener("selectend",$),s.removeEventListener("squeeze",$),s.removeEventListener("squeezestart",$),s.removeEventListener("squeezeend",$),s.removeEventListener("end",G),s.removeEventListener("inputsourceschange",ce);for(let ee=0;ee<P.length;ee++){let me=E[ee];me!==null&&(E[ee]=null,P[ee].disconnect(me))}I=null,W=null,g.reset();for(let ee in p)delete p[ee];if(e.setRenderTarget(A),f=null,d=null,u=null,s=null,S=null,ue.stop(),n.isPresenting=!1,e.setPixelRatio(T),e.setSize(x.width,x.height,!1),k!==null){let ee=k.camera;ee.fov=k.fov,ee.zoom=k.zoom,ee.updateProjectionMatrix(),k=null}n.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(ee){r=ee,n.isPresenting===!0&&$e("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(ee){a=ee,n.isPresenting===!0&&$e("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||o},this.setReferenceSpace=function(ee){c=ee},this.getBaseLayer=function(){return d!==null?d:f},this.getBinding=function(){return u===null&&_&&(u=new XRWebGLBinding(s,t)),u},this.getFrame=function(){return m},this.getSession=function(){return s},this.setSession=async function(ee){if(s=ee,s!==null){if(A=e.getRenderTarget(),s.addEventListener("select",$),s.addEventListener("selectstart",$),s.addEventListener("selectend",$),s.addEventListener("squeeze",$),s.addEventListener("squeezestart",$),s.addEventListener("squeezeend",$),s.addEventListener("end",G),s.addEventListener("inputsourceschange",ce),y.xrCompatible!==!0&&await t.makeXRCompatible(),T=e.getPixelRatio(),e.getSize(x),_&&"createProjectionLayer"in XRWebGLBinding.prototype){let xe=null,Ae=null,Se=null;y.depth&&(Se=y.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,xe=y.stencil?Ls:Es,Ae=y.stencil?Mr:Bi);let We={colorFormat:t.RGBA8,depthFormat:Se,scaleFactor:r};u=this.getBinding(),d=u.createProjectionLayer(We),s.updateRenderState({layers:[d]}),e.setPixelRatio(1),e.setSize(d.textureWidth,d.textureHeight,!1),S=new fi(d.textureWidth,d.textureHeight,{format:Vi,type:ni,depthTexture:new Cs(d.textureWidth,d.textureHeight,Ae,void 0,void 0,void 0,void 0,void 0,void 0,xe),stencilBuffer:y.stencil,colorSpace:e.outputColorSpace,samples:y.antialias?4:0,resolveDepthBuffer:d.ignoreDepthValues===!1,resolveStencilBuffer:d.ignoreDepthValues===!1,storeMultisampledDepthBuffer:d.ignoreDepthValues===!1,storeMultisampledStencilBuffer:d.ignoreDepthValues===!1})}else{let xe={antialias:y.antialias,alpha:!0,depth:y.depth,stencil:y.stencil,framebufferScaleFactor:r};f=new XRWebGLLayer(s,t,xe),s.updateRenderState({baseLayer:f}),e.setPixelRatio(1),e.setSize(f.framebufferWidth,f.framebufferHeight,!1),S=new fi(f.framebufferWidth,f.framebufferHeight,{format:Vi,type:ni,colorSpace:e.outputColorSpace,stencilBuffer:y.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}S.isXRRenderTarget=!0,this.setFoveation(l),c=null,o=await s.requestReferenceSpace(a),ue.setContext(s),ue.start(),n.isPresenting=!0,n.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return g.getDepthTexture()};function ce(ee){for(let me=0;me<ee.removed.length;me++){let xe=ee.removed[me],Ae=E.indexOf(xe);Ae>=0&&(E[Ae]=null,P[Ae].disconnect(xe))}for(let me=0;me<ee.added.length;me++){let xe=ee.added[me],Ae=E.indexOf(xe);if(Ae===-1){for(let We=0;We<P.length;We++)if(We>=E.length){E.push(xe),Ae=We;break}else if(E[We]===null){E[We]=xe,Ae=We;break}if(Ae===-1)break}let Se=P[Ae];Se&&Se.connect(xe)}}function J(ee,me){me===null?ee.matrixWorld.copy(ee.matrix):ee.matrixWorld.multiplyMatrices(me.matrixWorld,ee.matrix),ee.matrixWorldInverse.copy(ee.matrixWorld).invert()}this.updateCamera=function(ee){if(s===null)return;let me=ee.near,xe=ee.far;g.texture!==null&&(g.depthNear>0&&(me=g.depthNear),g.depthFar>0&&(xe=g.depthFar)),H.near=N.near=D.near=me,H.far=N.far=D.far=xe,(I!==H.near||W!==H.far)&&(s.updateRenderState({depthNear:H.near,depthFar:H.far}),I=H.near,W=H.far),H.layers.mask=ee.layers.mask|6,D.layers.mask=H.layers.mask&-5,N.layers.mask=H.layers.mask&-3;let Ae=ee.parent,Se=H.cameras;J(H,Ae);for(let We=0;We<Se.length;We++)J(Se[We],Ae);H.projectionMatrix.copy(D.projectionMatrix),H.projectionMatrixInverse.copy(D.projectionMatrixInverse),k===null&&ee.isPerspectiveCamera&&(k={camera:ee,fov:ee.fov,zoom:ee.zoom}),Q(ee,H,Ae)};function Q(ee,me,xe){xe===null?ee.matrix.copy(me.matrixWorld):(ee.matrix.copy(xe.matrixWorld),ee.matrix.invert(),ee.matrix.multiply(me.matrixWorld)),ee.matrix.decompose(ee.position,ee.quaternion,ee.scale),ee.updateMatrixWorld(!0),ee.projectionMatrix.copy(me.projectionMatrix),ee.projectionMatrixInverse.copy(me.projectionMatrixInverse),ee.isPerspectiveCamera&&(ee.fov=co*2*Math.atan(1/ee.projectionMatrix.elements[5]),ee.zoom=1)}this.getCamera=function(){return H},this.getFoveation=function(){if(!(d===null&&f===null))return l},this.setFoveation=function(ee){l=ee,d!==null&&(d.fixedFoveation=ee),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=ee)},this.hasDepthSensing=function(){return g.texture!==null},this.getDepthSensingMesh=function(){return g.getMesh(H)},this.getCameraTexture=function(ee){return p[ee]};let se=null;function de(ee,me){if(h=me.getViewerPose(c||o),m=me,h!==null){let xe=h.views;f!==null&&(e.setRenderTargetFramebuffer(S,f.framebuffer),e.setRenderTarget(S));let Ae=!1;xe.length!==H.cameras.length&&(H.cameras.length=0,Ae=!0);for(let Ve=0;Ve<xe.length;Ve++){let mt=xe[Ve],ht=null;if(f!==null)ht=f.getViewport(mt);else{let Jt=u.getViewSubImage(d,mt);ht=Jt.viewport,Ve===0&&(e.setRenderTargetTextures(S,Jt.colorTexture,Jt.depthStencilTexture),e.setRenderTarget(S))}let st=z[Ve];st===void 0&&(st=new Zn,st.layers.enable(Ve),st.viewport=new en,z[Ve]=st),st.matrix.fromArray(mt.transform.matrix),st.matrix.decompose(st.position,st.quaternion,st.scale),st.projectionMatrix.fromArray(mt.projectionMatrix),st.projectionMatrixInverse.copy(st.projectionMatrix).invert(),st.viewport.set(ht.x,ht.y,ht.width,ht.height),Ve===0&&(H.matrix.copy(st.matrix),H.matrix.decompose(H.position,H.quaternion,H.scale)),Ae===!0&&H.cameras.push(st)}let Se=s.enabledFeatures;if(Se&&Se.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&_){u=n.getBinding();let Ve=u.getDepthInformation(xe[0]);Ve&&Ve.isValid&&Ve.texture&&g.init(Ve,s.renderState)}if(Se&&Se.includes("camera-access")&&_){e.state.unbindTexture(),u=n.getBinding();for(let Ve=0;Ve<xe.length;Ve++){let mt=xe[Ve].camera;if(mt){let ht=p[mt];ht||(ht=new xa,p[mt]=ht);let st=u.getCameraImage(mt);ht.sourceTexture=st}}}}for(let xe=0;xe<P.length;xe++){let Ae=E[xe],Se=P[xe];Ae!==null&&Se!==void 0&&Se.update(Ae,me,c||o)}se&&se(ee,me),me.detectedPlanes&&n.dispatchEvent({type:"planesdetected",data:me}),m=null}let ue=new $g;ue.setAnimationLoop(de),this.setAnimationLoop=function(ee){se=ee},this.dispose=function(){}}},m1=new dt,s0=new it;s0.set(-1,0,0,0,1,0,0,0,1);function g1(i,e){function t(g,p){g.matrixAutoUpdate===!0&&g.updateMatrix(),p.value.copy(g.matrix)}function n(g,p){p.color.getRGB(g.fogColor.value,ff(i)),p.isFog?(g.fogNear.value=p.near,g.fogFar.value=p.far):p.isFogExp2&&(g.fogDensity.value=p.density)}function s(g,p,y,A,S){p.isNodeMaterial?p.uniformsNeedUpdate=!1:p.isMeshBasicMaterial?r(g,p):p.isMeshLambertMaterial?(r(g,p),p.envMap&&(g.envMapIntensity.value=p.envMapIntensity)):p.isMeshToonMaterial?(r(g,p),u(g,p)):p.isMeshPhongMaterial?(r(g,p),h(g,p),p.envMap&&(g.envMapIntensity.value=p.envMapIntensity)):p.isMeshStandardMaterial?(r(g,p),d(g,p),p.isMeshPhysicalMaterial&&f(g,p,S)):p.isMeshMatcapMaterial?(r(g,p),m(g,p)):p.isMeshDepthMaterial?r(g,p):p.isMeshDistanceMaterial?(r(g,p),_(g,p)):p.isMeshNormalMaterial?r(g,p):p.isLineBasicMaterial?(o(g,p),p.isLineDashedMaterial&&a(g,p)):p.isPointsMaterial?l(g,p,y,A):p.isSpriteMaterial?c(g,p):p.isShadowMaterial?(g.color.value.copy(p.color),g.opacity.value=p.opacity):p.isShaderMaterial&&(p.uniformsNeedUpdate=!1)}function r(g,p){g.opacity.value=p.opacity,p.color&&g.diffuse.value.copy(p.color),p.emissive&&g.emissive.value.copy(p.emissive).multiplyScalar(p.emissiveIntensity),p.map&&(g.map.value=p.map,t(p.map,g.mapTransform)),p.alphaMap&&(g.alphaMap.value=p.alphaMap,t(p.alphaMap,g.alphaMapTransform)),p.bumpMap&&(g.bumpMap.value=p.bumpMap,t(p.bumpMap,g.bumpMapTransform),g.bumpScale.value=p.bumpScale,p.side===Un&&(g.bumpScale.value*=-1)),p.normalMap&&(g.normalMap.value=p.normalMap,t(p.normalMap,g.normalMapTransform),g.normalScale.value.copy(p.normalScale),p.side===Un&&g.normalScale.value.negate()),p.displacementMap&&(g.displacementMap.value=p.displacementMap,t(p.displacementMap,g.displacementMapTransform),g.displacementScale.value=p.displacementScale,g.displacementBias.value=p.displacementBias),p.emissiveMap&&(g.emissiveMap.value=p.emissiveMap,t(p.emissiveMap,g.emissiveMapTransform)),p.specularMap&&(g.specularMap.value=p.specularMap,t(p.specularMap,g.specularMapTransform)),p.alphaTest>0&&(g.alphaTest.value=p.alphaTest);let y=e.get(p),A=y.envMap,S=y.envMapRotation;A&&(g.envMap.value=A,g.envMapRotation.value.setFromMatrix4(m1.makeRotationFromEuler(S)).transpose(),A.isCubeTexture&&A.isRenderTargetTexture===!1&&g.envMapRotation.value.premultiply(s0),g.reflectivity.value=p.reflectivity,g.ior.value=p.ior,g.refractionRatio.value=p.refractionRatio),p.lightMap&&(g.lightMap.value=p.lightMap,g.lightMapIntensity.value=p.lightMapIntensity,t(p.lightMap,g.lightMapTransform)),p.aoMap&&(g.aoMap.value=p.aoMap,g.aoMapIntensity.value=p.aoMapIntensity,t(p.aoMap,g.aoMapTransform))}function o(g,p){g.diffuse.value.copy(p.color),g.opacity.value=p.opacity,p.map&&(g.map.value=p.map,t(p.map,g.mapTransform))}function a(g,p){g.dashSize.value=p.dashSize,g.totalSize.value=p.dashSize+p.gapSize,g.scale.value=p.scale}function l(g,p,y,A){g.diffuse.value.copy(p.color),g.opacity.value=p.opacity,g.size.value=p.size*y,g.scale.value=A*.5,p.map&&(g.map.value=p.map,t(p.map,g.uvTransform)),p.alphaMap&&(g.alphaMap.value=p.alphaMap,t(p.alphaMap,g.alphaMapTransform)),p.alphaTest>0&&(g.alphaTest.value=p.alphaTest)}function c(g,p){g.diffuse.value.copy(p.color),g.opacity.value=p.opacity,g.rotation.value=p.rotation,p.map&&(g.map.value=p.map,t(p.map,g.mapTransform)),p.alphaMap&&(g.alphaMap.value=p.alphaMap,t(p.alphaMap,g.alphaMapTransform)),p.alphaTest>0&&(g.alphaTest.value=p.alphaTest)}function h(g,p){g.specular.value.copy(p.specular),g.shininess.value=Math.max(p.shininess,1e-4)}function u(g,p){p.gradientMap&&(g.gradientMap.value=p.gradientMap)}function d(g,p){g.metalness.value=p.metalness,p.metalnessMap&&(g.metalnessMap.value=p.metalnessMap,t(p.metalnessMap,g.metalnessMapTransform)),g.roughness.value=p.roughness,p.roughnessMap&&(g.roughnessMap.value=p.roughnessMap,t(p.roughnessMap,g.roughnessMapTransform)),p.envMap&&(g.envMapIntensity.value=p.envMapIntensity)}function f(g,p,y){g.ior.value=p.ior,p.diffuseRoughness>0&&(g.diffuseRoughness.value=p.diffuseRoughness,p.diffuseRoughnessMap&&(g.diffuseRoughnessMap.value=p.diffuseRoughnessMap,t(p.diffuseRoughnessMap,g.diffuseRoughnessMapTransform))),p.sheen>0&&(g.sheenColor.value.copy(p.sheenColor).multiplyScalar(p.sheen),g.sheenRoughness.value=p.sheenRoughness,p.sheenColorMap&&(g.sheenColorMap.value=p.sheenColorMap,t(p.sheenColorMap,g.sheenColorMapTransform)),p.sheenRoughnessMap&&(g.sheenRoughnessMap.value=p.sheenRoughnessMap,t(p.sheenRoughnessMap,g.sheenRoughnessMapTransform))),p.clearcoat>0&&(g.clearcoat.value=p.clearcoat,g.clearcoatRoughness.value=p.clearcoatRoughness,p.clearcoatMap&&(g.clearcoatMap.value=p.clearcoatMap,t(p.clearcoatMap,g.clearcoatMapTransform)),p.clearcoatRoughnessMap&&(g.clearcoatRoughnessMap.value=p.clearcoatRoughnessMap,t(p.clearcoatRoughnessMap,g.clearcoatRoughnessMapTransform)),p.clearcoatNormalMap&&(g.clearcoatNormalMap.value=p.clearcoatNormalMap,t(p.clearcoatNormalMap,g.clearcoatNormalMapTransform),g.clearcoatNormalScale.value.copy(p.clearcoatNormalScale),p.side===Un&&g.clearcoatNormalScale.value.negate())),p.dispersion>0&&(g.dispersion.value=p.dispersion),p.retroreflectivity>0&&(g.retroreflectivity.value=p.retroreflectivity),p.iridescence>0&&(g.iridescence.value=p.iridescence,g.iridescenceIOR.value=p.iridescenceIOR,g.iridescenceThicknessMinimum.value=p.iridescenceThicknessMinimum,g.iridescenceThicknessMaximum.value=p.iridescenceThicknessMaximum,p.iridescenceMap&&(g.iridescenceMap.value=p.iridescenceMap,t(p.iridescenceMap,g.iridescenceMapTransform)),p.iridescenceThicknessMap&&(g.iridescenceThicknessMap.value=p.iridescenceThicknessMap,t(p.iridescenceThicknessMap,g.iridescenceThicknessMapTransform))),p.transmission>0&&(g.transmission.value=p.transmission,g.transmissionSamplerMap.value=y.texture,g.transmissionSamplerSize.value.set(y.width,y.height),p.transmissionMap&&(g.transmissionMap.value=p.transmissionMap,t(p.transmissionMap,g.transmissionMapTransform)),g.thickness.value=p.thickness,p.thicknessMap&&(g.thicknessMap.value=p.thicknessMap,t(p.thicknessMap,g.thicknessMapTransform)),g.attenuationDistance.value=p.attenuationDistance,g.attenuationColor.value.copy(p.attenuationColor)),p.anisotropy>0&&(g.anisotropyVector.value.set(p.anisotropy*Math.cos(p.anisotropyRotation),p.anisotropy*Math.sin(p.anisotropyRotation)),p.anisotropyMap&&(g.anisotropyMap.value=p.anisotropyMap,t(p.anisotropyMap,g.anisotropyMapTransform))),g.specularIntensity.value=p.specularIntensity,g.specularColor.value.copy(p.specularColor),p.specularColorMap&&(g.specularColorMap.value=p.specularColorMap,t(p.specularColorMap,g.specularColorMapTransform)),p.specularIntensityMap&&(g.specularIntensityMap.value=p.specularIntensityMap,t(p.specularIntensityMap,g.specularIntensityMapTransform))}function m(g,p){p.matcap&&(g.matcap.value=p.matcap)}function _(g,p){let y=e.get(p).light;g.referencePosition.value.setFromMatrixPosition(y.matrixWorld),g.nearDistance.value=y.shadow.camera.near,g.farDistance.value=y.shadow.camera.far}return{refreshFogUniforms:n,refreshMaterialUniforms:s}}function v1(i,e,t,n){let s={},r={};function o(y,A){let S=A.program;n.uniformBlockBinding(y,S,s[y.id])}function a(y,A){let S=s[y.id];S===void 0&&(m(y),S=l(y),s[y.id]=S,y.addEventListener("dispose",g));let P=A.program;n.updateUBOMapping(y,P);let E=e.render.frame;r[y.id]!==E&&(c(y),r[y.id]=E)}function l(y){let A=i.createBuffer(),S=y.__size,P=y.usage;return i.bindBuffer(i.UNIFORM_BUFFER,A),i.bufferData(i.UNIFORM_BUFFER,S,P),i.bindBuffer(i.UNIFORM_BUFFER,null),A}function c(y){let A=s[y.id],S=y.uniforms,P=y.__cache;i.bindBuffer(i.UNIFORM_BUFFER,A);for(let E=0,x=S.length;E<x;E++){let T=S[E];if(Array.isArray(T))for(let k=0,D=T.length;k<D;k++)h(T[k],E,k,P);else h(T,E,0,P)}i.bindBuffer(i.UNIFORM_BUFFER,null)}function h(y,A,S,P){if(d(y,A,S,P)===!0){let E=y.__offset,x=y.value;if(Array.isArray(x)){let T=0;for(let k=0;k<x.length;k++){let D=x[k],N=_(D,!0);u(D,y.__data,T),T+=N.storage/Float32Array.BYTES_PER_ELEMENT}}else u(x,y.__data,0);i.bufferSubData(i.UNIFORM_BUFFER,E,y.__data)}}function u(y,A,S){typeof y=="number"||typeof y=="boolean"?A[S]=y:y.isMatrix3?(A[S]=y.elements[0],A[S+1]=y.elements[1],A[S+2]=y.elements[2],A[S+3]=0,A[S+4]=y.elements[3],A[S+5]=y.elements[4],A[S+6]=y.elements[5],A[S+7]=0,A[S+8]=y.elements[6],A[S+9]=y.elements[7],A[S+10]=y.elements[8],A[S+11]=0):ArrayBuffer.isView(y)?A.set(y.subarray(0,A.length-S),S):y.toArray(A,S)}function d(y,A,S,P){let E=y.value,x=A+"_"+S;if(Array.isArray(E)){P[x]===void 0&&(P[x]=[]);let T=P[x],k=!1;for(let D=0;D<E.length;D++)f(E[D],T,D)===!0&&(k=!0);return k}return f(E,P,x)}function f(y,A,S){if(A[S]===void 0)return typeof y=="number"||typeof y=="boolean"?A[S]=y:ArrayBuffer.isView(y)?A[S]=y.slice():A[S]=y.clone(),!0;{let P=A[S];if(typeof y=="number"||typeof y=="boolean"){if(P!==y)return A[S]=y,!0}else{if(ArrayBuffer.isView(y))return!0;if(P.equals(y)===!1)return P.copy(y),!0}}return!1}function m(y){let A=y.uniforms,S=0,P=16;for(let x=0,T=A.length;x<T;x++){let k=Array.isArray(A[x])?A[x]:[A[x]];for(let D=0,N=k.length;D<N;D++){let z=k[D],H=Array.isArray(z.value)?z.value:[z.value],I=Array.isArray(A[x])||Array.isArray(z.value),W=S;for(let G=0,ce=H.length;G<ce;G++){let J=H[G],Q=_(J,I),se=S%P,de=se%Q.boundary,ue=se+de;S+=de,ue!==0&&P-ue<Q.storage&&(S+=P-ue),G===0&&(W=S),S+=Q.storage}let $=z.type==="int"?Int32Array:z.type==="uint"?Uint32Array:Float32Array;z.__data=new $((S-W)/Float32Array.BYTES_PER_ELEMENT),z.__offset=W}}let E=S%P;return E>0&&(S+=P-E),y.__size=S,y.__cache={},this}function _(y,A){let S={boundary:0,storage:0};return typeof y=="number"||typeof y=="boolean"?(S.boundary=4,S.storage=4):y.isVector2?(S.boundary=8,S.storage=8):y.isVector3||y.isColor?(S.boundary=16,S.storage=12):y.isVector4?(S.boundary=16,S.storage=16):y.isMatrix3?(S.boundary=16,S.storage=48):y.isMatrix4?(S.boundary=16,S.storage=64):y.isTexture?$e("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(y)?(S.boundary=16,S.storage=y.byteLength):$e("WebGLRenderer: Unsupported uniform value type.",y),A===!0&&(S.boundary=16,S.storage=Math.ceil(S.storage/16)*16),S}function g(y){let A=y.target;A.removeEventListener("dispose",g),i.deleteBuffer(s[A.id]),delete s[A.id],delete r[A.id]}function p(){for(let y in s)i.deleteBuffer(s[y]);s={},r={}}return{bind:o,update:a,dispose:p}}var x1=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),hs=null;function y1(){return hs===null&&(hs=new pa(x1,16,16,er,zi),hs.name="DFG_LUT",hs.minFilter=Kn,hs.magFilter=Kn,hs.wrapS=ts,hs.wrapT=ts,hs.generateMipmaps=!1,hs.needsUpdate=!0),hs}var dh=class{constructor(e={}){let{canvas:t=vg(),context:n=null,depth:s=!0,stencil:r=!1,alpha:o=!1,antialias:a=!1,premultipliedAlpha:l=!0,preserveDrawingBuffer:c=!1,powerPreference:h="default",failIfMajorPerformanceCaveat:u=!1,reversedDepthBuffer:d=!1,outputBufferType:f=ni}=e;this.isWebGLRenderer=!0;let m;if(n!==null){if(typeof WebGLRenderingContext<"u"&&n instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");m=n.getContextAttributes().alpha}else m=o;let _=f,g=new Set([Lc,Pc,Rc]),p=new Set([ni,Bi,yo,Mr,Ec,Ac]),y=new Uint32Array(4),A=new Int32Array(4),S={textures:[],min:[],max:[],resolution:[]},P=null,E=null,x=[],T=[],k=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=cs,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let D=this,N=!1,z=null,H=null,I=null,W=null;this._outputColorSpace=$n;let $=0,G=0,ce=null,J=-1,Q=null,se=new en,de=new en,ue=null,ee=new qe(0),me=0,xe=t.width,Ae=t.height,Se=1,We=null,ot=null,Ve=new en(0,0,xe,Ae),mt=new en(0,0,xe,Ae),ht=!1,st=new Ys,Jt=new ic,Ht=!1,un=!1,Ut=new dt,En=new U,wt=new en,yn={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},nn=!1;function dn(){return ce===null?Se:1}let O=n;function Re(w,B){return t.getContext(w,B)}let Ze,at,Me,Bt,ze,Ye,C,b,q,he,oe,ve,ye,te,ie,pe,F,re,ne,we,ge,be,Ge;try{let w={alpha:!0,depth:s,stencil:r,antialias:a,premultipliedAlpha:l,preserveDrawingBuffer:c,powerPreference:h,failIfMajorPerformanceCaveat:u};if("setAttribute"in t&&t.setAttribute("data-engine",`three.js r${"187"}`),t.addEventListener("webglcontextlost",Ue,!1),t.addEventListener("webglcontextrestored",Qe,!1),t.addEventListener("webglcontextcreationerror",Ce,!1),O===null){let B="webgl2";if(O=Re(B,w),O===null)throw Re(B)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}je()}catch(w){throw t.removeEventListener("webglcontextlost",Ue,!1),t.removeEventListener("webglcontextrestored",Qe,!1),t.removeEventListener("webglcontextcreationerror",Ce,!1),nt("WebGLRenderer: "+w.message),w}function je(){Ze=new PM(O),Ze.init(),ge=new d1(O,Ze),at=new yM(O,Ze,e,ge),Me=new h1(O,Ze),at.reversedDepthBuffer&&d&&Me.buffers.depth.setReversed(!0),H=O.createFramebuffer(),I=O.createFramebuffer(),W=O.createFramebuffer(),Bt=new NM(O),ze=new Kw,Ye=new u1(O,Ze,Me,ze,at,ge,Bt),C=new RM(D),b=new F_(O),be=new vM(O,b),q=new LM(O,b,Bt,be),he=new FM(O,q,b,be,Bt),re=new DM(O,at,Ye),ie=new _M(ze),oe=new Zw(D,C,Ze,at,be,ie),ve=new g1(D,ze),ye=new jw,te=new s1(Ze),F=new gM(D,C,Me,he,m,l),pe=new c1(D,he,at),Ge=new v1(O,Bt,at,Me),ne=new xM(O,Ze,Bt),we=new IM(O,Ze,Bt),Bt.programs=oe.programs,D.capabilities=at,D.extensions=Ze,D.properties=ze,D.renderLists=ye,D.shadowMap=pe,D.state=Me,D.info=Bt}_!==ni&&(k=new UM(_,t.width,t.height,a,s,r));let le=new Ef(D,O);this.xr=le,this.getContext=function(){return O},this.getContextAttributes=function(){return O.getContextAttributes()},this.forceContextLoss=function(){let w=Ze.get("WEBGL_lose_context");w&&w.loseContext()},this.forceContextRestore=function(){let w=Ze.get("WEBGL_lose_context");w&&w.restoreContext()},this.getPixelRatio=function(){return Se},this.setPixelRatio=function(w){w!==void 0&&(Se=w,this.setSize(xe,Ae,!1))},this.getSize=function(w){return w.set(xe,Ae)},this.setSize=function(w,B,j=!0){if(le.isPresenting){$e("WebGLRenderer: Can't change size while VR device is presenting.");return}xe=w,Ae=B,t.width=Math.floor(w*Se),t.height=Math.floor(B*Se),j===!0&&(t.style.width=w+"px",t.style.height=B+"px"),k!==null&&k.setSize(t.width,t.height),this.setViewport(0,0,w,B)},this.getDrawingBufferSize=function(w){return w.set(xe*Se,Ae*Se).floor()},this.setDrawingBufferSize=function(w,B,j){xe=w,Ae=B,Se=j,t.width=Math.floor(w*j),t.height=Math.floor(B*j),this.setViewport(0,0,w,B)},this.setEffects=function(w){if(_===ni){nt("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(w){for(let B=0;B<w.length;B++)if(w[B].isOutputPass===!0){$e("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}k.setEffects(w||[])},this.getCurrentViewport=function(w){return w.copy(se)},this.getViewport=function(w){return w.copy(Ve)},this.setViewport=function(w,B,j,Y){w.isVector4?Ve.set(w.x,w.y,w.z,w.w):Ve.set(w,B,j,Y),Me.viewport(se.copy(Ve).multiplyScalar(dn()).round())},this.getScissor=function(w){return w.copy(mt)},this.setScissor=function(w,B,j,Y){w.isVector4?mt.set(w.x,w.y,w.z,w.w):mt.set(w,B,j,Y),Me.scissor(de.copy(mt).multiplyScalar(dn()).round())},this.getScissorTest=function(){return ht},this.setScissorTest=function(w){Me.setScissorTest(ht=w)},this.setOpaqueSort=function(w){We=w},this.setTransparentSort=function(w){ot=w},this.getClearColor=function(w){return w.copy(F.getClearColor())},this.setClearColor=function(){F.setClearColor(...arguments)},this.getClearAlpha=function(){return F.getClearAlpha()},this.setClearAlpha=function(){F.setClearAlpha(...arguments)},this.clear=function(w=!0,B=!0,j=!0){let Y=0;if(w){let Z=!1;if(ce!==null){let Te=ce.texture.format;Z=g.has(Te)}if(Z){let Te=ce.texture.type,Pe=p.has(Te),Ee=F.getClearColor(),Le=F.getClearAlpha(),Be=Ee.r,tt=Ee.g,vt=Ee.b;Pe?(y[0]=Be,y[1]=tt,y[2]=vt,y[3]=Le,O.clearBufferuiv(O.COLOR,0,y)):(A[0]=Be,A[1]=tt,A[2]=vt,A[3]=Le,O.clearBufferiv(O.COLOR,0,A))}else Y|=O.COLOR_BUFFER_BIT}B&&(Y|=O.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),j&&(Y|=O.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),Y!==0&&O.clear(Y)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(w){w.setRenderer(this),z=w},this.dispose=function(){t.removeEventListener("webglcontextlost",Ue,!1),t.removeEventListener("webglcontextrestored",Qe,!1),t.removeEventListener("webglcontextcreationerror",Ce,!1),F.dispose(),ye.dispose(),te.dispose(),Ye.dispose(),ze.dispose(),C.dispose(),he.dispose(),q.dispose(),be.dispose(),Ge.dispose(),oe.dispose(),le.dispose(),le.removeEventListener("sessionstart",dl),le.removeEventListener("sessionend",Yi),ps.stop()};function Ue(w){w.preventDefault(),cf("WebGLRenderer: Context Lost."),N=!0}function Qe(){cf("WebGLRenderer: Context Restored."),N=!1;let w=Bt.autoReset,B=pe.enabled,j=pe.autoUpdate,Y=pe.needsUpdate,Z=pe.type;je(),Bt.autoReset=w,pe.enabled=B,pe.autoUpdate=j,pe.needsUpdate=Y,pe.type=Z}function Ce(w){nt("WebGLRenderer: A WebGL context could not be created. Reason: ",w.statusMessage)}function lt(w){let B=w.target;B.removeEventListener("dispose",lt),Wt(B)}function Wt(w){Hn(w),ze.remove(w)}function Hn(w){let B=ze.get(w).programs;B!==void 0&&(B.forEach(function(j){oe.releaseProgram(j)}),w.isShaderMaterial&&oe.releaseShaderCache(w))}this.renderBufferDirect=function(w,B,j,Y,Z,Te){B===null&&(B=yn);let Pe=Z.isMesh&&Z.matrixWorld.determinantAffine()<0,Ee=Xo(w,B,j,Y,Z);Me.setMaterial(Y,Pe);let Le=j.index,Be=1;if(Y.wireframe===!0){if(Le=q.getWireframeAttribute(j),Le===void 0)return;Be=2}let tt=j.drawRange,vt=j.attributes.position,ke=tt.start*Be,xt=(tt.start+tt.count)*Be;Te!==null&&(ke=Math.max(ke,Te.start*Be),xt=Math.min(xt,(Te.start+Te.count)*Be)),Le!==null?(ke=Math.max(ke,0),xt=Math.min(xt,Le.count)):vt!=null&&(ke=Math.max(ke,0),xt=Math.min(xt,vt.count));let tn=xt-ke;if(tn<0||tn===1/0)return;be.setup(Z,Y,Ee,j,Le);let Dt,Ft=ne;if(Le!==null&&(Dt=b.get(Le),Ft=we,Ft.setIndex(Dt)),Z.isMesh)Y.wireframe===!0?(Me.setLineWidth(Y.wireframeLinewidth*dn()),Ft.setMode(O.LINES)):Ft.setMode(O.TRIANGLES);else if(Z.isLine){let _n=Y.linewidth;_n===void 0&&(_n=1),Me.setLineWidth(_n*dn()),Z.isLineSegments?Ft.setMode(O.LINES):Z.isLineLoop?Ft.setMode(O.LINE_LOOP):Ft.setMode(O.LINE_STRIP)}else Z.isPoints?Ft.setMode(O.POINTS):Z.isSprite&&Ft.setMode(O.TRIANGLES);if(Z.isBatchedMesh)if(Ze.get("WEBGL_multi_draw"))Ft.renderMultiDraw(Z._multiDrawStarts,Z._multiDrawCounts,Z._multiDrawCount);else{let _n=Z._multiDrawStarts,Fe=Z._multiDrawCounts,fn=Z._multiDrawCount,bt=Le?b.get(Le).bytesPerElement:1,gs=ze.get(Y).currentProgram.getUniforms();for(let pn=0;pn<fn;pn++)gs.setValue(O,"_gl_DrawID",pn),Ft.render(_n[pn]/bt,Fe[pn])}else if(Z.isInstancedMesh)Ft.renderInstances(ke,tn,Z.count);else if(j.isInstancedBufferGeometry){let _n=j._maxInstanceCount!==void 0?j._maxInstanceCount:1/0,Fe=Math.min(j.instanceCount,_n);Ft.renderInstances(ke,tn,Fe)}else Ft.render(ke,tn)};function Go(w,B,j,Y){z!==null&&w.isNodeMaterial&&z.setObject(Y,w),Ht===!0&&ie.setState(w,j,!1),w.transparent===!0&&w.side===Ai&&w.forceSinglePass===!1?(w.side=Un,w.needsUpdate=!0,$i(w,B,Y),w.side=ls,w.needsUpdate=!0,$i(w,B,Y),w.side=Ai):$i(w,B,Y)}this.compile=function(w,B,j=null){j===null&&(j=w),z!==null&&z.renderStart(w,B,j),E=te.get(j),E.init(B),T.push(E),j.traverseVisible(function(Z){Z.isLight&&Z.layers.test(B.layers)&&(E.pushLight(Z),Z.castShadow&&E.pushShadow(Z))}),w!==j&&w.traverseVisible(function(Z){Z.isLight&&Z.layers.test(B.layers)&&(E.pushLight(Z),Z.castShadow&&E.pushShadow(Z))}),E.setupLights(),z!==null&&z.updateLights(E.state.lightsArray),un=this.localClippingEnabled,Ht=ie.init(this.clippingPlanes,un),Ht===!0&&ie.setGlobalState(this.clippingPlanes,B),z!==null&&pe.render(E.state.shadowsArray,j,B);let Y=new Set;return w.traverse(function(Z){if(!(Z.isMesh||Z.isPoints||Z.isLine||Z.isSprite))return;let Te=Z.material;if(Te)if(Array.isArray(Te))for(let Pe=0;Pe<Te.length;Pe++){let Ee=Te[Pe];Go(Ee,j,B,Z),Y.add(Ee)}else Go(Te,j,B,Z),Y.add(Te)}),E=T.pop(),z!==null&&z.renderEnd(),Y},this.compileAsync=function(w,B,j=null){let Y=this.compile(w,B,j);return new Promise(Z=>{function Te(){if(Y.forEach(function(Pe){let Le=ze.get(Pe).currentProgram;(Le===void 0||Le.isReady())&&Y.delete(Pe)}),Y.size===0){Z(w);return}setTimeout(Te,10)}Ze.get("KHR_parallel_shader_compile")!==null?Te():setTimeout(Te,10)})};let Nr=null;function Qu(w){Nr&&Nr(w)}function dl(){ps.stop()}function Yi(){ps.start()}let ps=new $g;ps.setAnimationLoop(Qu),typeof self<"u"&&ps.setContext(self),this.setAnimationLoop=function(w){Nr=w,le.setAnimationLoop(w),w===null?ps.stop():ps.start()},le.addEventListener("sessionstart",dl),le.addEventListener("sessionend",Yi),this.render=function(w,B){if(B!==void 0&&B.isCamera!==!0){nt("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(N===!0)return;z!==null&&z.renderStart(w,B);let j=le.enabled===!0&&le.isPresenting===!0,Y=k!==null&&(ce===null||j)&&k.begin(D,ce);if(w.matrixWorldAutoUpdate===!0&&w.updateMatrixWorld(),B.parent===null&&B.matrixWorldAutoUpdate===!0&&B.updateMatrixWorld(),le.enabled===!0&&le.isPresenting===!0&&(k===null||k.isCompositing()===!1)&&(le.cameraAutoUpdate===!0&&le.updateCamera(B),B=le.getCamera()),w.isScene===!0&&w.onBeforeRender(D,w,B,ce),E=te.get(w,T.length),E.init(B),E.state.textureUnits=Ye.getTextureUnits(),T.push(E),Ut.multiplyMatrices(B.projectionMatrix,B.matrixWorldInverse),B.isArrayCamera?Jt.setFromArrayCamera(B):st.setFromProjectionMatrix(Ut,Ti,B.reversedDepth),un=this.localClippingEnabled,Ht=ie.init(this.clippingPlanes,un),P=ye.get(w,x.length),P.init(),x.push(P),this.info.render.frame++,le.enabled===!0&&le.isPresenting===!0){let Pe=D.xr.getDepthSensingMesh();Pe!==null&&ms(Pe,B,-1/0,D.sortObjects)}ms(w,B,0,D.sortObjects),P.finish(),z!==null&&z.updateLights(E.state.lightsArray),D.sortObjects===!0&&P.sort(We,ot),nn=le.enabled===!1||le.isPresenting===!1||le.hasDepthSensing()===!1,nn&&F.addToRenderList(P,w),this.info.autoReset===!0&&this.info.reset(),Ht===!0&&ie.beginShadows();let Z=E.state.shadowsArray;if(pe.render(Z,w,B),Ht===!0&&ie.endShadows(),(Y&&k.hasRenderPass())===!1){let Pe=P.opaque,Ee=P.transmissive;if(E.setupLights(),B.isArrayCamera){let Le=B.cameras;if(Ee.length>0)for(let Be=0,tt=Le.length;Be<tt;Be++){let vt=Le[Be];Ii(Pe,Ee,w,vt)}nn&&F.render(w);for(let Be=0,tt=Le.length;Be<tt;Be++){let vt=Le[Be];Ho(P,w,vt,vt.viewport)}}else Ee.length>0&&Ii(Pe,Ee,w,B),nn&&F.render(w),Ho(P,w,B)}ce!==null&&G===0&&(Ye.updateMultisampleRenderTarget(ce),Ye.updateRenderTargetMipmap(ce)),Y&&k.end(D),w.isScene===!0&&w.onAfterRender(D,w,B),be.resetDefaultState(),J=-1,Q=null,T.pop(),T.length>0?(E=T[T.length-1],Ye.setTextureUnits(E.state.textureUnits),Ht===!0&&ie.setGlobalState(D.clippingPlanes,E.state.camera)):E=null,x.pop(),x.length>0?P=x[x.length-1]:P=null,z!==null&&z.renderEnd()};function ms(w,B,j,Y){if(w.visible===!1)return;if(w.layers.test(B.layers)){if(w.isGroup)j=w.renderOrder;else if(w.isLOD)w.autoUpdate===!0&&w.update(B);else if(w.isLight)E.pushLight(w),w.castShadow&&E.pushShadow(w);else if(w.isSprite){let Pe=B.isArrayCamera?Jt:st;if(!w.frustumCulled||w.intersectsFrustum(Pe)){Y&&wt.setFromMatrixPosition(w.matrixWorld).applyMatrix4(Ut);let Ee=he.update(w),Le=w.material;Le.visible&&P.push(w,Ee,Le,j,wt.z,null,B)}}else if(w.isMesh||w.isLine||w.isPoints){let Pe=B.isArrayCamera?Jt:st;if(!w.frustumCulled||w.intersectsFrustum(Pe)){let Ee=he.update(w),Le=w.material;if(Y&&(w.boundingSphere!==void 0?(w.boundingSphere===null&&w.computeBoundingSphere(),wt.copy(w.boundingSphere.center)):(Ee.boundingSphere===null&&Ee.computeBoundingSphere(),wt.copy(Ee.boundingSphere.center)),wt.applyMatrix4(w.matrixWorld).applyMatrix4(Ut)),Array.isArray(Le)){let Be=Ee.groups;for(let tt=0,vt=Be.length;tt<vt;tt++){let ke=Be[tt],xt=Le[ke.materialIndex];xt&&xt.visible&&P.push(w,Ee,xt,j,wt.z,ke,B)}}else Le.visible&&P.push(w,Ee,Le,j,wt.z,null,B)}}}let Te=w.children;for(let Pe=0,Ee=Te.length;Pe<Ee;Pe++)ms(Te[Pe],B,j,Y)}function Ho(w,B,j,Y){let{opaque:Z,transmissive:Te,transparent:Pe}=w;E.setupLightsView(j),Ht===!0&&ie.setGlobalState(D.clippingPlanes,j),Y&&Me.viewport(se.copy(Y)),Z.length>0&&sn(Z,B,j),Te.length>0&&sn(Te,B,j),Pe.length>0&&sn(Pe,B,j),Me.buffers.depth.setTest(!0),Me.buffers.depth.setMask(!0),Me.buffers.color.setMask(!0),Me.setPolygonOffset(!1)}function Ii(w,B,j,Y){if((j.isScene===!0?j.overrideMaterial:null)!==null)return;if(E.state.transmissionRenderTarget[Y.id]===void 0){let ke=Ze.has("EXT_color_buffer_half_float")||Ze.has("EXT_color_buffer_float");E.state.transmissionRenderTarget[Y.id]=new fi(1,1,{generateMipmaps:!0,type:ke?zi:ni,minFilter:Ps,samples:Math.max(4,at.samples),stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:yt.workingColorSpace})}let Te=E.state.transmissionRenderTarget[Y.id],Pe=Y.viewport||se;Te.setSize(Pe.z*D.transmissionResolutionScale,Pe.w*D.transmissionResolutionScale);let Ee=D.getRenderTarget(),Le=D.getActiveCubeFace(),Be=D.getActiveMipmapLevel();D.setRenderTarget(Te),D.getClearColor(ee),me=D.getClearAlpha(),me<1&&D.setClearColor(16777215,.5),D.clear(),nn&&F.render(j);let tt=D.toneMapping;D.toneMapping=cs;let vt=Y.viewport;if(Y.viewport!==void 0&&(Y.viewport=void 0),E.setupLightsView(Y),Ht===!0&&ie.setGlobalState(D.clippingPlanes,Y),sn(w,j,Y),Ye.updateMultisampleRenderTarget(Te),Ye.updateRenderTargetMipmap(Te),Ze.has("WEBGL_multisampled_render_to_texture")===!1){let ke=!1;for(let xt=0,tn=B.length;xt<tn;xt++){let Dt=B[xt],{object:Ft,geometry:_n,material:Fe,group:fn}=Dt;if(Fe.side===Ai&&Ft.layers.test(Y.layers)){let bt=Fe.side;Fe.side=Un,Fe.needsUpdate=!0,cn(Ft,j,Y,_n,Fe,fn),Fe.side=bt,Fe.needsUpdate=!0,ke=!0}}ke===!0&&(Ye.updateMultisampleRenderTarget(Te),Ye.updateRenderTargetMipmap(Te))}D.setRenderTarget(Ee,Le,Be),D.setClearColor(ee,me),vt!==void 0&&(Y.viewport=vt),D.toneMapping=tt}function sn(w,B,j){let Y=B.isScene===!0?B.overrideMaterial:null;for(let Z=0,Te=w.length;Z<Te;Z++){let Pe=w[Z],{object:Ee,geometry:Le,group:Be}=Pe,tt=Pe.material;tt.allowOverride===!0&&Y!==null&&(tt=Y),Ee.layers.test(j.layers)&&cn(Ee,B,j,Le,tt,Be)}}function cn(w,B,j,Y,Z,Te){z!==null&&Z.isNodeMaterial&&z.setObject(w,Z),w.onBeforeRender(D,B,j,Y,Z,Te),w.modelViewMatrix.multiplyMatrices(j.matrixWorldInverse,w.matrixWorld),w.normalMatrix.getNormalMatrix(w.modelViewMatrix),Z.onBeforeRender(D,B,j,Y,w,Te),Z.transparent===!0&&Z.side===Ai&&Z.forceSinglePass===!1?(Z.side=Un,Z.needsUpdate=!0,D.renderBufferDirect(j,B,Y,Z,w,Te),Z.side=ls,Z.needsUpdate=!0,D.renderBufferDirect(j,B,Y,Z,w,Te),Z.side=Ai):D.renderBufferDirect(j,B,Y,Z,w,Te),w.onAfterRender(D,B,j,Y,Z,Te)}function hn(w){let B=0;for(let j of w)j.texture!==null&&B++;return B}function $i(w,B,j){B.isScene!==!0&&(B=yn);let Y=ze.get(w),Z=E.state.lights,Te=E.state.shadowsArray,Pe=Z.state.version,Ee=oe.getParameters(w,Z.state,Te,B,j,E.state.lightProbeGridArray),Le=oe.getProgramCacheKey(Ee),Be=Y.programs;Y.environment=w.isMeshStandardMaterial||w.isMeshLambertMaterial||w.isMeshPhongMaterial?B.environment:null,Y.fog=B.fog;let tt=w.isMeshStandardMaterial||w.isMeshLambertMaterial&&!w.envMap||w.isMeshPhongMaterial&&!w.envMap;Y.envMap=C.get(w.envMap||Y.environment,tt),Y.envMapRotation=Y.environment!==null&&w.envMap===null?B.environmentRotation:w.envMapRotation,Be===void 0&&(w.addEventListener("dispose",lt),Be=new Map,Y.programs=Be,Y.programVariants=new Map);let vt=Be.get(Le);if(vt!==void 0){if(Y.currentProgram===vt&&Y.lightsStateVersion===Pe)return Wo(w,Ee),vt}else Ee.uniforms=oe.getUniforms(w),z!==null&&w.isNodeMaterial&&z.build(w,j,Ee),w.onBeforeCompile(Ee,D),vt=oe.acquireProgram(Ee,Le),Be.set(Le,vt),Y.uniforms=Ee.uniforms;let ke=Y.uniforms;return(!w.isShaderMaterial&&!w.isRawShaderMaterial||w.clipping===!0)&&(ke.clippingPlanes=ie.uniform),Wo(w,Ee),Y.needsLights=Us(w),Y.lightsStateVersion=Pe,Y.needsLights&&(ke.ambientLightColor.value=Z.state.ambient,ke.lightProbe.value=Z.state.probe,ke.sunLights.value=Z.state.sun,ke.sunLightShadows.value=Z.state.sunShadow,ke.directionalLights.value=Z.state.directional,ke.directionalLightShadows.value=Z.state.directionalShadow,ke.spotLights.value=Z.state.spot,ke.spotLightShadows.value=Z.state.spotShadow,ke.rectAreaLights.value=Z.state.rectArea,ke.ltc_1.value=Z.state.rectAreaLTC1,ke.ltc_2.value=Z.state.rectAreaLTC2,ke.pointLights.value=Z.state.point,ke.pointLightShadows.value=Z.state.pointShadow,ke.hemisphereLights.value=Z.state.hemi,ke.sunShadowMatrix.value=Z.state.sunShadowMatrix,ke.sunShadowCascade.value=Z.state.sunShadowCascade,ke.directionalShadowMatrix.value=Z.state.directionalShadowMatrix,ke.spotLightMatrix.value=Z.state.spotLightMatrix,ke.spotLightMap.value=Z.state.spotLightMap,ke.pointShadowMatrix.value=Z.state.pointShadowMatrix),Y.numLightProbeGrids=hn(E.state.lightProbeGridArray),Y.currentProgram=vt,Y.uniformsList=null,vt}function oi(w,B,j,Y,Z){let Te=ze.get(w),Pe=Te.currentProgram.id+","+Y+","+Z,Ee=Te.programVariants.get(Pe);return Ee===void 0?(Ee=$i(w,B,j),Te.programVariants.set(Pe,Ee)):(Te.currentProgram=Ee,Te.uniformsList=null,Te.outputColorSpace=Y,Te.toneMapping=Z),Ee}function Os(w){if(w.uniformsList===null){let B=w.currentProgram.getUniforms();w.uniformsList=bo.seqWithValue(B.seq,w.uniforms)}return w.uniformsList}function Wo(w,B){let j=ze.get(w);j.outputColorSpace=B.outputColorSpace,j.batching=B.batching,j.batchingColor=B.batchingColor,j.instancing=B.instancing,j.instancingColor=B.instancingColor,j.instancingMorph=B.instancingMorph,j.skinning=B.skinning,j.morphTargets=B.morphTargets,j.morphNormals=B.morphNormals,j.morphColors=B.morphColors,j.morphTargetsCount=B.morphTargetsCount,j.numClippingPlanes=B.numClippingPlanes,j.numIntersection=B.numClipIntersection,j.vertexAlphas=B.vertexAlphas,j.vertexTangents=B.vertexTangents,j.toneMapping=B.toneMapping}function Xo(w,B,j,Y,Z){B.isScene!==!0&&(B=yn),Ye.resetTextureUnits();let Te=B.fog,Pe=Y.isMeshStandardMaterial||Y.isMeshLambertMaterial||Y.isMeshPhongMaterial?B.environment:null,Ee=ce===null?D.outputColorSpace:ce.isXRRenderTarget===!0?ce.texture.colorSpace:yt.workingColorSpace,Le=Y.isMeshStandardMaterial||Y.isMeshLambertMaterial&&!Y.envMap||Y.isMeshPhongMaterial&&!Y.envMap,Be=C.get(Y.envMap||Pe,Le),tt=Y.vertexColors===!0&&!!j.attributes.color&&j.attributes.color.itemSize===4,vt=!!j.attributes.tangent&&(!!Y.normalMap||Y.anisotropy>0),ke=!!j.morphAttributes.position,xt=!!j.morphAttributes.normal,tn=!!j.morphAttributes.color,Dt=cs;Y.toneMapped&&(ce===null||ce.isXRRenderTarget===!0)&&(Dt=D.toneMapping);let Ft=j.morphAttributes.position||j.morphAttributes.normal||j.morphAttributes.color,_n=Ft!==void 0?Ft.length:0,Fe=ze.get(Y),fn=E.state.lights;if(Ht===!0&&(un===!0||w!==Q)){let Ot=w===Q&&Y.id===J;ie.setState(Y,w,Ot)}let bt=!1,gs=!1;Y.version===Fe.__version?Fe.needsLights&&Fe.lightsStateVersion!==fn.state.version||Z.isBatchedMesh&&Fe.batching===!1||!Z.isBatchedMesh&&Fe.batching===!0||Z.isBatchedMesh&&Fe.batchingColor===!0&&Z._colorsTexture===null||Z.isBatchedMesh&&Fe.batchingColor===!1&&Z._colorsTexture!==null||Z.isInstancedMesh&&Fe.instancing===!1||!Z.isInstancedMesh&&Fe.instancing===!0||Z.isSkinnedMesh&&Fe.skinning===!1||!Z.isSkinnedMesh&&Fe.skinning===!0||Z.isInstancedMesh&&Fe.instancingColor===!0&&Z.instanceColor===null||Z.isInstancedMesh&&Fe.instancingColor===!1&&Z.instanceColor!==null||Z.isInstancedMesh&&Fe.instancingMorph===!0&&Z.morphTexture===null||Z.isInstancedMesh&&Fe.instancingMorph===!1&&Z.morphTexture!==null||Fe.envMap!==Be||Y.fog===!0&&Fe.fog!==Te||Fe.numClippingPlanes!==void 0&&(Fe.numClippingPlanes!==ie.numPlanes||Fe.numIntersection!==ie.numIntersection)||Fe.vertexAlphas!==tt||Fe.vertexTangents!==vt||Fe.morphTargets!==ke||Fe.morphNormals!==xt||Fe.morphColors!==tn||Fe.morphTargetsCount!==_n||Fe.numLightProbeGrids!==hn(E.state.lightProbeGridArray)?bt=!0:(Fe.outputColorSpace!==Ee||Fe.toneMapping!==Dt)&&(gs=!0):(bt=!0,Fe.__version=Y.version);let pn=Fe.currentProgram;(bt===!0||gs===!0)&&(pn=gs===!0?oi(Y,B,Z,Ee,Dt):$i(Y,B,Z),z&&Y.isNodeMaterial&&z.onUpdateProgram(Y,pn,Fe));let Or=!1,Zi=!1,vs=!1,ut=pn.getUniforms(),rn=Fe.uniforms;if(Me.useProgram(pn.program)&&(Or=!0,Zi=!0,vs=!0),Y.id!==J&&(J=Y.id,Zi=!0),Or||Q!==w){Me.buffers.depth.getReversed()&&w.reversedDepth!==!0&&(w._reversedDepth=!0,w.updateProjectionMatrix()),ut.setValue(O,"projectionMatrix",w.projectionMatrix),ut.setValue(O,"viewMatrix",w.matrixWorldInverse);let mn=ut.map.cameraPosition;mn!==void 0&&mn.setValue(O,En.setFromMatrixPosition(w.matrixWorld)),at.logarithmicDepthBuffer&&ut.setValue(O,"logDepthBufFC",2/(Math.log(w.far+1)/Math.LN2)),(Y.isMeshPhongMaterial||Y.isMeshToonMaterial||Y.isMeshLambertMaterial||Y.isMeshBasicMaterial||Y.isMeshStandardMaterial||Y.isShaderMaterial)&&ut.setValue(O,"isOrthographic",w.isOrthographicCamera===!0),Q!==w&&(Q=w,Zi=!0,vs=!0)}if(Fe.needsLights&&(fn.state.sunShadowMap.length>0&&ut.setValue(O,"sunShadowMap",fn.state.sunShadowMap,Ye),fn.state.directionalShadowMap.length>0&&ut.setValue(O,"directionalShadowMap",fn.state.directionalShadowMap,Ye),fn.state.spotShadowMap.length>0&&ut.setValue(O,"spotShadowMap",fn.state.spotShadowMap,Ye),fn.state.pointShadowMap.length>0&&ut.setValue(O,"pointShadowMap",fn.state.pointShadowMap,Ye)),Z.isSkinnedMesh){ut.setOptional(O,Z,"bindMatrix"),ut.setOptional(O,Z,"bindMatrixInverse");let Ot=Z.skeleton;Ot&&(Ot.boneTexture===null&&Ot.computeBoneTexture(),ut.setValue(O,"boneTexture",Ot.boneTexture,Ye))}Z.isBatchedMesh&&(ut.setOptional(O,Z,"batchingTexture"),ut.setValue(O,"batchingTexture",Z._matricesTexture,Ye),ut.setOptional(O,Z,"batchingIdTexture"),ut.setValue(O,"batchingIdTexture",Z._indirectTexture,Ye),ut.setOptional(O,Z,"batchingColorTexture"),Z._colorsTexture!==null&&ut.setValue(O,"batchingColorTexture",Z._colorsTexture,Ye));let Wn=j.morphAttributes;if((Wn.position!==void 0||Wn.normal!==void 0||Wn.color!==void 0)&&re.update(Z,j,pn),(Zi||Fe.receiveShadow!==Z.receiveShadow)&&(Fe.receiveShadow=Z.receiveShadow,ut.setValue(O,"receiveShadow",Z.receiveShadow)),(Y.isMeshStandardMaterial||Y.isMeshLambertMaterial||Y.isMeshPhongMaterial)&&Y.envMap===null&&B.environment!==null&&(rn.envMapIntensity.value=B.environmentIntensity),rn.dfgLUT!==void 0&&(rn.dfgLUT.value=y1()),Zi){if(ut.setValue(O,"toneMappingExposure",D.toneMappingExposure),Fe.needsLights&&Dr(rn,vs),Te&&Y.fog===!0&&ve.refreshFogUniforms(rn,Te),ve.refreshMaterialUniforms(rn,Y,Se,Ae,E.state.transmissionRenderTarget[w.id]),Fe.needsLights&&Fe.numLightProbeGrids>0){let Ot=S,mn=0;for(let Bn of E.state.lightProbeGridArray)Bn.texture!==null&&(Ot.textures[mn]=Bn.texture,Ot.min[mn]=Bn.boundingBox.min,Ot.max[mn]=Bn.boundingBox.max,Ot.resolution[mn]=Bn.resolution,mn++);for(let Bn in Ot)Ot[Bn].length=mn;rn.probesSH.value=Ot.textures,rn.probesMin.value=Ot.min,rn.probesMax.value=Ot.max,rn.probesResolution.value=Ot.resolution}bo.upload(O,Os(Fe),rn,Ye)}if(Y.isShaderMaterial&&Y.uniformsNeedUpdate===!0&&(bo.upload(O,Os(Fe),rn,Ye),Y.uniformsNeedUpdate=!1),Y.isSpriteMaterial&&ut.setValue(O,"center",Z.center),ut.setValue(O,"modelViewMatrix",Z.modelViewMatrix),ut.setValue(O,"normalMatrix",Z.normalMatrix),ut.setValue(O,"modelMatrix",Z.matrixWorld),Y.uniformsGroups!==void 0){let Ot=Y.uniformsGroups;for(let mn=0,Bn=Ot.length;mn<Bn;mn++){let fl=Ot[mn];Ge.update(fl,pn),Ge.bind(fl,pn)}}return pn}function Dr(w,B){w.ambientLightColor.needsUpdate=B,w.lightProbe.needsUpdate=B,w.sunLights.needsUpdate=B,w.sunLightShadows.needsUpdate=B,w.directionalLights.needsUpdate=B,w.directionalLightShadows.needsUpdate=B,w.pointLights.needsUpdate=B,w.pointLightShadows.needsUpdate=B,w.spotLights.needsUpdate=B,w.spotLightShadows.needsUpdate=B,w.rectAreaLights.needsUpdate=B,w.hemisphereLights.needsUpdate=B}function Us(w){return w.isMeshLambertMaterial||w.isMeshToonMaterial||w.isMeshPhongMaterial||w.isMeshStandardMaterial||w.isShadowMaterial||w.isShaderMaterial&&w.lights===!0}this.getActiveCubeFace=function(){return $},this.getActiveMipmapLevel=function(){return G},this.getRenderTarget=function(){return ce},this.setRenderTargetTextures=function(w,B,j){let Y=ze.get(w);Y.__autoAllocateDepthBuffer=w.resolveDepthBuffer===!1,Y.__autoAllocateDepthBuffer===!1&&(Y.__useRenderToTexture=!1),ze.get(w.texture).__webglTexture=B,ze.get(w.depthTexture).__webglTexture=Y.__autoAllocateDepthBuffer?void 0:j,Y.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(w,B){let j=ze.get(w);j.__webglFramebuffer=B,j.__useDefaultFramebuffer=B===void 0},this.setRenderTarget=function(w,B=0,j=0){ce=w,$=B,G=j;let Y=null,Z=!1,Te=!1;if(w){let Ee=ze.get(w);if(Ee.__useDefaultFramebuffer!==void 0){Me.bindFramebuffer(O.FRAMEBUFFER,Ee.__webglFramebuffer),se.copy(w.viewport),de.copy(w.scissor),ue=w.scissorTest,Me.viewport(se),Me.scissor(de),Me.setScissorTest(ue),J=-1;return}else if(Ee.__webglFramebuffer===void 0)Ye.setupRenderTarget(w);else if(Ee.__hasExternalTextures)Ye.rebindTextures(w,ze.get(w.texture).__webglTexture,ze.get(w.depthTexture).__webglTexture);else if(w.depthBuffer){let tt=w.depthTexture;if(Ee.__boundDepthTexture!==tt){if(tt!==null&&ze.has(tt)&&(w.width!==tt.image.width||w.height!==tt.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");Ye.setupDepthRenderbuffer(w)}}let Le=w.texture;(Le.isData3DTexture||Le.isDataArrayTexture||Le.isCompressedArrayTexture)&&(Te=!0);let Be=ze.get(w).__webglFramebuffer;w.isWebGLCubeRenderTarget?(Array.isArray(Be[B])?Y=Be[B][j]:Y=Be[B],Z=!0):w.samples>0&&Ye.useMultisampledRTT(w)===!1?Y=ze.get(w).__webglMultisampledFramebuffer:Array.isArray(Be)?Y=Be[j]:Y=Be,se.copy(w.viewport),de.copy(w.scissor),ue=w.scissorTest}else se.copy(Ve).multiplyScalar(Se).floor(),de.copy(mt).multiplyScalar(Se).floor(),ue=ht;if(j!==0&&(Y=H),Me.bindFramebuffer(O.FRAMEBUFFER,Y)&&Me.drawBuffers(w,Y),Me.viewport(se),Me.scissor(de),Me.setScissorTest(ue),Z){let Ee=ze.get(w.texture);O.framebufferTexture2D(O.FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_CUBE_MAP_POSITIVE_X+B,Ee.__webglTexture,j)}else if(Te){let Ee=B;for(let Le=0;Le<w.textures.length;Le++){let Be=ze.get(w.textures[Le]);O.framebufferTextureLayer(O.FRAMEBUFFER,O.COLOR_ATTACHMENT0+Le,Be.__webglTexture,j,Ee)}}else if(w!==null&&j!==0){let Ee=ze.get(w.texture);O.framebufferTexture2D(O.FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_2D,Ee.__webglTexture,j)}J=-1};function Fr(w){let B=ze.get(w);return(B.__readFormat!==w.format||B.__readType!==w.type)&&(B.__readFormat=w.format,B.__readType=w.type,B.__formatReadable=at.textureFormatReadable(w.format),B.__typeReadable=at.textureTypeReadable(w.type)),B}this.readRenderTargetPixels=function(w,B,j,Y,Z,Te,Pe,Ee=0){if(!(w&&w.isWebGLRenderTarget)){nt("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let Le=ze.get(w).__webglFramebuffer;if(w.isWebGLCubeRenderTarget&&Pe!==void 0&&(Le=Le[Pe],Array.isArray(Le)&&(Le=Le[0])),Le){Me.bindFramebuffer(O.FRAMEBUFFER,Le);try{let Be=w.textures[Ee],tt=Be.format,vt=Be.type;w.textures.length>1&&O.readBuffer(O.COLOR_ATTACHMENT0+Ee);let ke=Fr(Be);if(ke.__formatReadable===!1){nt("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(ke.__typeReadable===!1){nt("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}B>=0&&B<=w.width-Y&&j>=0&&j<=w.height-Z&&O.readPixels(B,j,Y,Z,ge.convert(tt),ge.convert(vt),Te)}finally{let Be=ce!==null?ze.get(ce).__webglFramebuffer:null;Me.bindFramebuffer(O.FRAMEBUFFER,Be)}}},this.readRenderTargetPixelsAsync=async function(w,B,j,Y,Z,Te,Pe,Ee=0){if(!(w&&w.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let Le=ze.get(w).__webglFramebuffer;if(w.isWebGLCubeRenderTarget&&Pe!==void 0&&(Le=Le[Pe],Array.isArray(Le)&&(Le=Le[0])),Le)if(B>=0&&B<=w.width-Y&&j>=0&&j<=w.height-Z){Me.bindFramebuffer(O.FRAMEBUFFER,Le);let Be=w.textures[Ee],tt=Be.format,vt=Be.type;w.textures.length>1&&O.readBuffer(O.COLOR_ATTACHMENT0+Ee);let ke=Fr(Be);if(ke.__formatReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(ke.__typeReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");let xt=O.createBuffer();O.bindBuffer(O.PIXEL_PACK_BUFFER,xt),O.bufferData(O.PIXEL_PACK_BUFFER,Te.byteLength,O.STREAM_READ),O.readPixels(B,j,Y,Z,ge.convert(tt),ge.convert(vt),0),O.bindBuffer(O.PIXEL_PACK_BUFFER,null);let tn=ce!==null?ze.get(ce).__webglFramebuffer:null;Me.bindFramebuffer(O.FRAMEBUFFER,tn);let Dt=O.fenceSync(O.SYNC_GPU_COMMANDS_COMPLETE,0);return O.flush(),await yg(O,Dt,4),O.bindBuffer(O.PIXEL_PACK_BUFFER,xt),O.getBufferSubData(O.PIXEL_PACK_BUFFER,0,Te),O.bindBuffer(O.PIXEL_PACK_BUFFER,null),O.deleteBuffer(xt),O.deleteSync(Dt),Te}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(w,B=null,j=0){let Y=Math.pow(2,-j),Z=Math.floor(w.image.width*Y),Te=Math.floor(w.image.height*Y),Pe=B!==null?B.x:0,Ee=B!==null?B.y:0;Ye.setTexture2D(w,0),O.copyTexSubImage2D(O.TEXTURE_2D,j,0,0,Pe,Ee,Z,Te),Me.unbindTexture()},this.copyTextureToTexture=function(w,B,j=null,Y=null,Z=0,Te=0){let Pe,Ee,Le,Be,tt,vt,ke,xt,tn,Dt=w.isCompressedTexture?w.mipmaps[Te]:w.image;if(j!==null)Pe=j.max.x-j.min.x,Ee=j.max.y-j.min.y,Le=j.isBox3?j.max.z-j.min.z:1,Be=j.min.x,tt=j.min.y,vt=j.isBox3?j.min.z:0;else{let ut=Math.pow(2,-Z);Pe=Math.floor(Dt.width*ut),Ee=Math.floor(Dt.height*ut),w.isDataArrayTexture?Le=Dt.depth:w.isData3DTexture?Le=Math.floor(Dt.depth*ut):Le=1,Be=0,tt=0,vt=0}Y!==null?(ke=Y.x,xt=Y.y,tn=Y.z):(ke=0,xt=0,tn=0);let Ft=ge.convert(B.format),_n=ge.convert(B.type),Fe;B.isData3DTexture?(Ye.setTexture3D(B,0),Fe=O.TEXTURE_3D):B.isDataArrayTexture||B.isCompressedArrayTexture?(Ye.setTexture2DArray(B,0),Fe=O.TEXTURE_2D_ARRAY):(Ye.setTexture2D(B,0),Fe=O.TEXTURE_2D),Me.activeTexture(O.TEXTURE0),Me.pixelStorei(O.UNPACK_FLIP_Y_WEBGL,B.flipY),Me.pixelStorei(O.UNPACK_PREMULTIPLY_ALPHA_WEBGL,B.premultiplyAlpha),Me.pixelStorei(O.UNPACK_ALIGNMENT,B.unpackAlignment);let fn=Me.getParameter(O.UNPACK_ROW_LENGTH),bt=Me.getParameter(O.UNPACK_IMAGE_HEIGHT),gs=Me.getParameter(O.UNPACK_SKIP_PIXELS),pn=Me.getParameter(O.UNPACK_SKIP_ROWS),Or=Me.getParameter(O.UNPACK_SKIP_IMAGES);Me.pixelStorei(O.UNPACK_ROW_LENGTH,Dt.width),Me.pixelStorei(O.UNPACK_IMAGE_HEIGHT,Dt.height),Me.pixelStorei(O.UNPACK_SKIP_PIXELS,Be),Me.pixelStorei(O.UNPACK_SKIP_ROWS,tt),Me.pixelStorei(O.UNPACK_SKIP_IMAGES,vt);let Zi=w.isDataArrayTexture||w.isData3DTexture,vs=B.isDataArrayTexture||B.isData3DTexture;if(w.isDepthTexture){let ut=ze.get(w),rn=ze.get(B),Wn=ze.get(ut.__renderTarget),Ot=ze.get(rn.__renderTarget);Me.bindFramebuffer(O.READ_FRAMEBUFFER,Wn.__webglFramebuffer),Me.bindFramebuffer(O.DRAW_FRAMEBUFFER,Ot.__webglFramebuffer);for(let mn=0;mn<Le;mn++)Zi&&(O.framebufferTextureLayer(O.READ_FRAMEBUFFER,O.COLOR_ATTACHMENT0,ze.get(w).__webglTexture,Z,vt+mn),O.framebufferTextureLayer(O.DRAW_FRAMEBUFFER,O.COLOR_ATTACHMENT0,ze.get(B).__webglTexture,Te,tn+mn)),O.blitFramebuffer(Be,tt,Be+Pe,tt+Ee,ke,xt,ke+Pe,xt+Ee,O.DEPTH_BUFFER_BIT,O.NEAREST);Me.bindFramebuffer(O.READ_FRAMEBUFFER,null),Me.bindFramebuffer(O.DRAW_FRAMEBUFFER,null)}else if(Z!==0||w.isRenderTargetTexture||ze.has(w)){let ut=ze.get(w),rn=ze.get(B);Me.bindFramebuffer(O.READ_FRAMEBUFFER,I),Me.bindFramebuffer(O.DRAW_FRAMEBUFFER,W);for(let Wn=0;Wn<Le;Wn++)Zi?O.framebufferTextureLayer(O.READ_FRAMEBUFFER,O.COLOR_ATTACHMENT0,ut.__webglTexture,Z,vt+Wn):O.framebufferTexture2D(O.READ_FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_2D,ut.__webglTexture,Z),vs?O.framebufferTextureLayer(O.DRAW_FRAMEBUFFER,O.COLOR_ATTACHMENT0,rn.__webglTexture,Te,tn+Wn):O.framebufferTexture2D(O.DRAW_FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_2D,rn.__webglTexture,Te),Z!==0?O.blitFramebuffer(Be,tt,Be+Pe,tt+Ee,ke,xt,ke+Pe,xt+Ee,O.COLOR_BUFFER_BIT,O.NEAREST):vs?O.copyTexSubImage3D(Fe,Te,ke,xt,tn+Wn,Be,tt,Pe,Ee):O.copyTexSubImage2D(Fe,Te,ke,xt,Be,tt,Pe,Ee);Me.bindFramebuffer(O.READ_FRAMEBUFFER,null),Me.bindFramebuffer(O.DRAW_FRAMEBUFFER,null)}else vs?w.isDataTexture||w.isData3DTexture?O.texSubImage3D(Fe,Te,ke,xt,tn,Pe,Ee,Le,Ft,_n,Dt.data):B.isCompressedArrayTexture?O.compressedTexSubImage3D(Fe,Te,ke,xt,tn,Pe,Ee,Le,Ft,Dt.data):O.texSubImage3D(Fe,Te,ke,xt,tn,Pe,Ee,Le,Ft,_n,Dt):w.isDataTexture?O.texSubImage2D(O.TEXTURE_2D,Te,ke,xt,Pe,Ee,Ft,_n,Dt.data):w.isCompressedTexture?O.compressedTexSubImage2D(O.TEXTURE_2D,Te,ke,xt,Dt.width,Dt.height,Ft,Dt.data):O.texSubImage2D(O.TEXTURE_2D,Te,ke,xt,Pe,Ee,Ft,_n,Dt);Me.pixelStorei(O.UNPACK_ROW_LENGTH,fn),Me.pixelStorei(O.UNPACK_IMAGE_HEIGHT,bt),Me.pixelStorei(O.UNPACK_SKIP_PIXELS,gs),Me.pixelStorei(O.UNPACK_SKIP_ROWS,pn),Me.pixelStorei(O.UNPACK_SKIP_IMAGES,Or),Te===0&&B.generateMipmaps===!0&&B.mipmapsAutoUpdate===!0&&O.generateMipmap(Fe),Me.unbindTexture()},this.initRenderTarget=function(w){ze.get(w).__webglFramebuffer===void 0&&Ye.setupRenderTarget(w)},this.initTexture=function(w){w.isCubeTexture?Ye.setTextureCube(w,0):w.isData3DTexture?Ye.setTexture3D(w,0):w.isDataArrayTexture||w.isCompressedArrayTexture?Ye.setTexture2DArray(w,0):Ye.setTexture2D(w,0),Me.unbindTexture()},this.resetState=function(){$=0,G=0,ce=null,Me.reset(),be.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return Ti}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=yt._getDrawingBufferColorSpace(e),t.unpackColorSpace=yt._getUnpackColorSpace()}};var si=(i,e)=>[i[0]+e[0],i[1]+e[1],i[2]+e[2]],ii=(i,e)=>[i[0]-e[0],i[1]-e[1],i[2]-e[2]],jn=(i,e)=>[i[0]*e,i[1]*e,i[2]*e],tr=(i,e)=>i[0]*e[0]+i[1]*e[1]+i[2]*e[2],Zt=i=>Math.hypot(i[0],i[1],i[2]),r0=(i,e)=>[i[1]*e[2]-i[2]*e[1],i[2]*e[0]-i[0]*e[2],i[0]*e[1]-i[1]*e[0]];function mh(i,e){let t=[i[1],i[2],i[3]],n=jn(r0(t,e),2);return si(si(e,jn(n,i[0])),r0(t,n))}function Af(i,e){return mh([i[0],-i[1],-i[2],-i[3]],e)}function o0(i,e,t){let n=ii(t,e),s=ii(i.origin,e),[r,o,a]=[tr(n,n),tr(n,i.direction),tr(n,s)],l=r-o*o,c=l>1e-9*r?(a-o*tr(i.direction,s))/l:.5,h=si(e,jn(n,Math.min(Math.max(c,0),1))),u=Math.max(tr(ii(h,i.origin),i.direction),0);return{point:h,gap:Zt(ii(si(i.origin,jn(i.direction,u)),h)),depth:u}}function a0(i,e,t){let n=tr(i.direction,e);return n>.05?si(i.origin,jn(i.direction,t/n)):null}function l0(i,e,t){let n=(e-i.origin[2])/i.direction[2];return n>0&&n<t?si(i.origin,jn(i.direction,n)):null}function c0(i,e){return Math.min(Math.max(i*Math.exp(-6e-4*e),.3),200)}function h0(i,e){let t=Math.hypot(i[0],i[1])>.001?[i[0],i[1],0]:[e[0],e[1],0],n=jn(t,1/Math.max(Zt(t),1e-9));return[n,[-n[1],n[0],0]]}var Cf={ArrowUp:[1,0,0],KeyW:[1,0,0],ArrowDown:[-1,0,0],KeyS:[-1,0,0],ArrowLeft:[0,1,0],KeyA:[0,1,0],ArrowRight:[0,-1,0],KeyD:[0,-1,0],KeyE:[0,0,1],PageUp:[0,0,1],KeyQ:[0,0,-1],PageDown:[0,0,-1]},Rf=.15,_1=.02,b1=200,Pf=.05,Lf=({kind:i,frequency:e})=>i==="shake"?{frequency:e}:{},gh=class{constructor(e,t,n,s){this.camera=e;this.options=t;this.send=n;this.listening=s;s&&(window.addEventListener("keydown",this.down),window.addEventListener("keyup",this.up),window.addEventListener("blur",this.release),document.addEventListener("visibilitychange",this.release))}camera;options;send;listening;pressed=new Set;sent=[0,0,0];stamp=0;askAgain=0;flush(e){if(!this.listening)return;let t=e?[0,0,0]:this.inWorld(this.input());!(Zt(t)===0&&Zt(this.sent)>0)&&(Zt(ii(t,this.sent))<_1||performance.now()<this.askAgain)||(this.sent=t,this.send({type:"force",force:t,point:[0,0,0],...Lf(this.options)},this.stamp||performance.now()),this.stamp=0)}refuse(){this.askAgain=performance.now()+b1}release=()=>{this.pressed.clear(),this.flush(!0)};input(){let e=document.hasFocus()?S1():[0,0,0];for(let t of this.pressed)e=si(e,Cf[t]);return jn(e,this.options.force/Math.max(Zt(e),1))}inWorld([e,t,n]){if(this.options.directions==="world"||e===0&&t===0)return[e,t,n];let s=this.camera.getWorldDirection(new U).toArray(),r=new U(0,1,0).applyQuaternion(this.camera.quaternion).toArray(),[o,a]=h0(s,r);return si(si(jn(o,e),jn(a,t)),[0,0,n])}down=e=>{if(e.key==="Meta"&&this.pressed.clear(),!(!(e.code in Cf)||e.ctrlKey||e.metaKey||e.altKey||Va(e))){if(e.preventDefault(),this.options.kind==="tap"){let t=this.inWorld(jn(Cf[e.code],this.options.force));e.repeat||this.send({type:"force",force:t,point:[0,0,0],duration:Pf},e.timeStamp);return}this.stamp||=e.timeStamp,this.pressed.add(e.code)}};up=e=>{this.pressed.delete(e.code)&&(this.stamp||=e.timeStamp)}};function Va({target:i,code:e}){return i instanceof HTMLElement?i.matches("input[type=range]")&&/^(Arrow|Page|Home|End)/.test(e)||i.closest("input:not([type=checkbox], [type=range]), select, textarea, dialog")!==null:!1}function S1(){let i=navigator.getGamepads().find(t=>t?.connected),e=t=>{let n=i?.axes[t]??0;return Math.abs(n)<Rf?0:-Math.sign(n)*((Math.abs(n)-Rf)/(1-Rf))};return[e(1),e(0),e(3)]}var M1=.07,w1=30,u0=12,T1=33,E1=40,A1=1e-4,C1=7,vh=class{constructor(e){this.page=e;let{surface:t}=e,n={capture:!0,passive:!1};t.addEventListener("pointerdown",this.down,n),t.addEventListener("pointermove",this.move,n),t.addEventListener("pointerrawupdate",this.moveNow,n),t.addEventListener("wheel",this.wheel,n);for(let s of["pointerup","pointercancel","lostpointercapture"])t.addEventListener(s,this.up,n);t.addEventListener("pointerleave",()=>this.over=null),window.addEventListener("blur",this.release),document.addEventListener("visibilitychange",this.release)}page;held=null;cursor=new He;stamp=0;sent=0;over=null;second=null;get pulling(){return this.held!==null}get hand(){return this.held?{kind:"pull",point:this.held.point,target:this.held.target}:this.over?{kind:"offer",point:this.over}:{kind:"none"}}flush(){if(!this.held)return;let{held:e}=this,t=this.targetOf(e);if(!t||Zt(ii(t,e.target))<A1)return;e.target=t,this.sent=performance.now();let n=e.shakenFrom&&jn(ii(t,e.shakenFrom),this.page.stiffness()),s=n&&{type:"force",force:n,point:e.point,...Lf(this.page.options)};this.page.send(s??{type:"move",target:t},this.stamp||this.sent),this.stamp=0}release=()=>{this.held&&(this.cancel(),this.page.send({type:"release"},performance.now()))};cancel(e=1/0){if(!this.held||this.held.seq>e)return;let{pointer:t}=this.held;this.held=this.second=this.over=null,this.page.surface.hasPointerCapture(t)&&this.page.surface.releasePointerCapture(t),this.page.surface.classList.remove("pulling")}down=e=>{if(this.held){this.second={pointer:e.pointerId,y:e.clientY},e.stopImmediatePropagation();return}if(e.button!==0||e.shiftKey||e.ctrlKey)return;this.note(e);let t=this.pick(e.pointerType==="mouse"?u0:w1);t&&(e.stopImmediatePropagation(),e.preventDefault(),document.activeElement?.blur(),this.begin(e,t))};begin(e,t){let n=this.page.frame(),s=this.page.options.at==="centre",r=s?[0,0,0]:t,o=si(n.vector("position"),mh(n.attitude,t)),a=this.page.camera.position.toArray(),l=tr(ii(o,a),this.ahead()),c=this.page.options.plane==="level"?o[2]:null,h=this.hit(l,c)??o,u=si(n.vector("position"),mh(n.attitude,r)),{kind:d,force:f}=this.page.options;if(d==="tap"){let g=jn(this.ray().direction,f);this.page.send({type:"force",force:g,point:r,duration:Pf},e.timeStamp);return}let m={type:"grab",point:r,target:u,at:s?"centre":"point"},_=d==="shake"?1/0:this.page.send(m,e.timeStamp)??0;this.page.surface.setPointerCapture(e.pointerId),this.held={pointer:e.pointerId,point:r,offset:ii(u,h),depth:l,height:c,target:u,seq:_,shakenFrom:d==="shake"?u:null},this.page.surface.classList.add("pulling")}move=e=>{this.held&&e.stopImmediatePropagation(),this.second?.pointer===e.pointerId&&(this.shiftPlane(2*(e.clientY-this.second.y)),this.second.y=e.clientY),!(this.held&&e.pointerId!==this.held.pointer)&&(this.note(e),!(this.held||e.pointerType!=="mouse")&&(this.over=e.buttons?null:this.pick(u0),this.page.surface.classList.toggle("over",this.over!==null)))};moveNow=e=>{e.pointerId!==this.held?.pointer||performance.now()-this.sent<C1||(this.note(e),this.flush())};up=e=>{this.second?.pointer===e.pointerId&&(this.second=null),this.held?.pointer===e.pointerId&&(e.stopImmediatePropagation(),this.release())};wheel=e=>{if(!this.held)return;e.stopImmediatePropagation(),e.preventDefault();let t=e.deltaMode?T1*e.deltaY:e.deltaY;this.shiftPlane(Math.max(-300,Math.min(300,t))),this.stamp||=e.timeStamp};note(e){let t=this.page.surface.getBoundingClientRect(),[n,s]=[(e.clientX-t.left)/t.width,(e.clientY-t.top)/t.height];this.cursor.set(2*n-1,1-2*s),this.stamp||=e.timeStamp}targetOf(e){let t=this.hit(e.depth,e.height);return t&&si(t,e.offset)}hit(e,t){return t===null?a0(this.ray(),this.ahead(),e):l0(this.ray(),t,E1)}shiftPlane(e){let t=this.held,n=c0(t.depth,e);t.height===null?t.depth=n:t.height+=.3*(n-t.depth)}pick(e){let[t,n]=[this.page.frame(),this.page.axis()];if(!t||!n)return null;let s=this.ray(),r={origin:Af(t.attitude,ii(s.origin,t.vector("position"))),direction:Af(t.attitude,s.direction)},{point:o,gap:a,depth:l}=o0(r,n.from,n.to),{camera:c,surface:h}=this.page,u=2*l*Math.tan(c.fov*Math.PI/360)/h.clientHeight;return a<Math.max(n.radius+M1,n.radius+e*u)?o:null}ray(){let{camera:e}=this.page;e.updateMatrixWorld();let t=new U(this.cursor.x,this.cursor.y,.5).unproject(e).sub(e.position).normalize();return{origin:e.position.toArray(),direction:t.toArray()}}ahead(){return this.page.camera.getWorldDirection(new U).toArray()}};var R1=[0,0,0],xh=class{text="";statuses=0;refused=null;refuse(e,t){let n=t.kind==="none"?R1:t.point;this.refused={text:e,point:n,until:performance.now()+5e3}}status({holder:e,refusals:t,ending:n}){this.text=e==="none"||n?"":t.push,this.statuses=this.text?this.statuses+1:0}now(e){if(this.refused&&performance.now()<this.refused.until)return this.refused;if(this.statuses<2)return null;let t=e.vector(e.scalar("held")>0?"hand_point":"push_point");return{text:this.text,point:t}}};function X(i,e={},...t){let n=document.createElement(i);for(let[s,r]of Object.entries(e))r===void 0||r===!1||n.setAttribute(s,r===!0?"":String(r));return n.append(...t),n}function Ke(i){return document.getElementById(i)}var P1="http://www.w3.org/2000/svg";function gi(i,e={},...t){let n=document.createElementNS(P1,i);for(let[s,r]of Object.entries(e))n.setAttribute(s,String(r));return n.append(...t),n}function Gi(i){return gi("svg",{"aria-hidden":"true"},gi("use",{href:`#i-${i}`}))}function Tt(i,e,t,n,s=""){let r=X("button",{type:"button",title:t,class:s},Gi(i),X("span",{},e));return r.addEventListener("click",n),r}function nr(i,e,t,n=[]){let s=X("select",i,...n),r=!1,o=null,a=()=>{let l=o;o=null,l!==null&&l===s.value&&e(l)};return s.addEventListener("pointerdown",()=>r=!1),s.addEventListener("keydown",({key:l,altKey:c})=>{r=!c&&l!==" "&&l!=="Enter",l==="Enter"&&a()}),s.addEventListener("change",()=>{o=s.value,(!r||!t)&&a(),r||s.blur()}),s.addEventListener("blur",a),s}function Ri(i,e,t,n){let s=Object.keys(e).map(r=>{let o=X("button",{type:"button","aria-pressed":String(r===t)},e[r]);return o.addEventListener("click",()=>{for(let a of s)a.setAttribute("aria-pressed",String(a===o));n(r)}),o});return X("div",{class:"choice",role:"group","aria-label":i},...s)}function d0(i,e){[...i.children].forEach((t,n)=>t.setAttribute("aria-pressed",String(n===e)))}function Ga(i,e,t){let n=X("input",{type:"checkbox",checked:e});return n.addEventListener("change",()=>t(n.checked)),X("label",{class:"toggle"},n,X("span",{},i))}function If(i,e,t){let[n,s]=[Ke(i),Ke(e)],r=o=>{n.setAttribute("aria-pressed",String(o)),s.hidden=!o,document.body.classList.toggle(`no-${e}`,!o)};n.addEventListener("click",()=>r(s.hidden!==!1)),r(t)}var Nf=new Map;function Ha(i){let e=Nf.get(i)??L1(i);return Nf.set(i,e),e}function f0(){Nf.clear()}function L1(i){let e=X("i",{hidden:!0});e.style.color=`var(${i})`,document.body.append(e);let{color:t}=getComputedStyle(e);return e.remove(),t}function yh(i){return Array.isArray(i)?i:[i,i,i]}function _h(i,e,t){return i.map(n=>n.key===e?{...n,value:t}:n)}var vi=(i,e)=>JSON.stringify(i)===JSON.stringify(e);function Wa(i){let e=new Date().toISOString().slice(0,19).replace("T","-").replaceAll(":","");return`${i.slice(0,64-e.length-1)}-${e}`}function p0(){try{return window.localStorage}catch{return null}}function Df(i){return p0()?.getItem(i)??null}function Mo(i,e){try{p0()?.setItem(i,e)}catch{}}function bh(i){try{return JSON.parse(Df(i)??"null")}catch{return null}}var Sh=.1,m0={time:"s",touches:"",effort:"N s",jerk:"",score:"s"},g0="Fly from your first push to the end of the corridor. The lowest score wins: seconds, 5 a touch, 1 for 5 N s, 1 a unit of jerk. The hand moves level.",I1="This flight was pushed before: a new run counts from its first push.",wo=7,Mh=class{constructor(e,t,n){this.challenged=n;this.button=Tt("flag","Challenge","Score a flight through the corridor",()=>this.ask());let s=Object.keys(m0).map(r=>{let o=X("dd",{},"\u2013");return this.parts.set(r,o),X("div",{class:r},X("dt",{},r),o)});this.handIn=Tt("save","Save to hand in","",()=>e(Wa(`${this.scene.mission}-${this.score.score.toFixed(1)}s`)),"go"),this.actions=X("div",{hidden:!0},this.handIn,Tt("reset","New run","Begin the flight again",t)),this.element.append(X("div",{class:"strip"},X("dl",{},...s),this.note,this.actions))}challenged;element=X("div",{id:"challenge",class:"refusal-row",hidden:!0});button;parts=new Map;note=X("p",{},g0);actions;handIn;on=!1;late=!1;scene=null;score=null;start=NaN;time=NaN;poses=[];best=null;altered=new Map;begin(e){this.scene=e,this.best=bh(this.place)??null,this.altered.clear();for(let{key:t,value:n,initial:s}of e.parameters)this.altered.set(t,!vi(n,s??n));this.restart(),this.button.hidden=!e.corridor,this.show(this.on)}changed(e,t){let n=this.scene?.parameters.find(s=>s.key===e);n&&this.altered.set(e,!vi(t,n.initial??n.value))}frame(e){let t=e.scalar("time");t<this.time-1e-4&&this.rewind(t),this.time=t,Number.isNaN(this.start)&&e.vector("push").some(n=>n!==0)&&(this.start=t),!(this.score?.finished||this.score?.refused||!(t>=this.start+Sh*this.poses.length/wo))&&this.poses.push(...[...e.vector("position"),...e.attitude].map(n=>Math.round(1e3*n)/1e3))}status(e){let t=this.score?.refused?this.score:e.score,n=t?.finished&&!this.score?.finished;this.score=t??null,t&&(this.start=t.start),n&&this.end(t),this.offer()}tick(){if(this.element.hidden)return;let e=this.late?null:this.score,t=this.late?NaN:this.start,n=e?.finished||e?.refused?e.time:this.time-t;for(let[r,o]of this.parts){let a=r==="time"?n:e?.[r],l=a===void 0||Number.isNaN(a)?"\u2013":a.toFixed(r==="touches"?0:1),c=l==="\u2013"?l:`${l} ${m0[r]}`;o.textContent!==c&&(o.textContent=c)}let s=this.remark();this.note.textContent!==s&&(this.note.textContent=s)}get rival(){let e=this.best?.poses;if(this.element.hidden||this.late||!e?.length)return null;let t=Math.max((this.time-this.start||0)/Sh,0),n=Math.floor(t);if(wo*(n+2)>e.length)return null;let s=r=>{let[o,a]=[e[wo*n+r],e[wo*(n+1)+r]];return o+(t-n)*(a-o)};return{position:[s(0),s(1),s(2)],attitude:[s(3),s(4),s(5),s(6)]}}get place(){return`tandemlift.best.${this.scene?.mission}`}remark(){let{score:e,best:t}=this;if(this.late)return I1;if(e?.refused)return`Not ranked: ${e.refused}.`;let n=[...this.altered].filter(([,r])=>r).map(([r])=>r),s=n.length?` Changed settings count only if they are free: ${n.join(", ")}.`:"";return e?.finished?e.score<=(t?.score??1/0)?`Your best run.${s}`:`Your best: ${t.score.toFixed(1)} s.${s}`:(t&&!e?`Your best: ${t.score.toFixed(1)} s; its ghost flies along. `:e?"":g0)+s}end(e){if(!this.on||this.late||e.refused||e.score>=(this.best?.score??1/0))return;let t=this.poses.slice(0,wo*(Math.floor(e.time/Sh)+2));this.best={score:e.score,poses:t},Mo(this.place,JSON.stringify(this.best))}rewind(e){if(!(e>=this.start)){this.restart();return}this.score=null,this.poses.length=Math.min(this.poses.length,wo*Math.floor((e-this.start)/Sh+1))}restart(){[this.start,this.time,this.score,this.poses,this.late]=[NaN,NaN,null,[],!1],this.offer()}ask(){this.late=!Number.isNaN(this.start),this.show(!this.on),this.offer()}offer(){let{score:e,late:t}=this;this.actions.hidden=!t&&!e?.finished&&!e?.refused,this.handIn.hidden=t||!e?.finished||e.refused!==""}show(e){this.on=e,this.button.setAttribute("aria-pressed",String(e)),this.element.hidden=!e||!this.scene?.corridor,this.challenged(!this.element.hidden)}};function Th(i){return i===0||!Number.isFinite(i)?String(i):String(Number(i.toPrecision(4)))}var wh=class{constructor(e,t){this.low=e;this.high=t;this.logarithmic=e>0&&t/e>60}low;high;logarithmic;place(e){let t=Math.min(Math.max(e,this.low),this.high),n=this.logarithmic?Math.log(t/this.low)/Math.log(this.high/this.low):(t-this.low)/(this.high-this.low);return Math.round(1e3*n)}value(e){let t=e/1e3,{low:n,high:s}=this,r=this.logarithmic?n*(s/n)**t:n+t*(s-n);return[3,4,5,6].map(a=>Number(r.toPrecision(a))).find(a=>a>=n&&a<=s&&this.place(a)===e)??r}};function Xa(i){let e=[i].flat().map(t=>typeof t=="number"?Th(t):String(t));return[...new Set(e)].length===1?e[0]:e.join(", ")}var N1="keep these settings as a ghost",D1="The ghost has the same settings: change one, and see.",Eh=class{menu;element=X("div",{id:"comparison",class:"refusal-row",hidden:!0});text=X("span");ended=X("span");constructor(e){let t=o=>{this.menu.selectedIndex=0,e?.(o?"fly":"keep",o)};this.menu=nr({title:"Fly a second flight under the same hand","aria-label":"Compare"},t,!0);let n=o=>()=>e?.(o),s=Tt("again","Swap","Fly the ghost, and let this flight be the ghost",n("swap")),r=Tt("close","End","Fly without a ghost",n("end"));this.element.append(X("div",{class:"strip"},X("p",{role:"status"},this.text,this.ended),s,r))}begin(e=[]){let t=e.map(({name:s,title:r})=>X("option",{value:s,title:r},`with ${s}, from the start`)),n=X("option",{value:""},N1);this.menu.replaceChildren(X("option",{hidden:!0},"Compare \u2026"),n,...t)}status({ghost:e=""}){this.ended.textContent!==e&&(this.ended.textContent=e&&` The ghost ${e}.`)}show({mission:e,controller:t,parameters:n,ghost:s}){if(this.element.hidden=!s,!s)return;let r=a=>`${a.mission} (${a.controller})`,o=s.mission===e?"":`Ghost: ${r(s)}, now: ${r({mission:e,controller:t})}. `;this.text.textContent=o+F1(s.parameters,n)||D1}};function F1(i,e){let t=e.flatMap(({key:n,label:s,group:r,value:o,unit:a})=>{let l=i.find(h=>h.key===n);return!l||vi(l.value,o)?[]:[`${e.filter(h=>h.label===s).length>1?`${r} ${s}`:s} ${Xa(l.value)}, now: ${Xa(o)} ${a??""}`.trim()]});return t.length?`Ghost: ${t.join("; ")}.`:""}var v0=["phase","alarm","contact_part","contact_point","contact_normal","held","seq"],To="admittance.threshold",x0="person.stiffness",qa="person.max_force";var Ya={spotlight:["push","moment","speed","x","y","height","error","disturbance","thrust","contact","wind","time"],camera:["behind","side","above","board"],ask:["lift","land"],ghost:["keep","end"]},y0={force:{frequency:{min:0,max:10},duration:{min:0,max:1}},kill:{rotor:{min:0,max:255}},speed:{factor:{min:.1,max:1}},rewind:{time:{min:0,max:1e5}}};var _0={preparing:{text:"preparing",kind:"off",tint:"rgba(0, 0, 0, 0)"},idle:{text:"on the ground",kind:"off",tint:"rgba(93, 104, 117, 0.10)"},lift:{text:"lifting",kind:"moving",tint:"rgba(240, 180, 41, 0.16)"},guided:{text:"follows pushes",kind:"active",tint:"rgba(31, 157, 118, 0.13)"},land:{text:"landing",kind:"moving",tint:"rgba(240, 180, 41, 0.16)"},hold:{text:"holding",kind:"calm",tint:"rgba(47, 111, 176, 0.12)"},contact:{text:"touching a wall",kind:"moving",tint:"rgba(240, 180, 41, 0.16)"},crashed:{text:"crashed",kind:"fault",tint:"rgba(213, 40, 27, 0.12)"},diverged:{text:"out of control",kind:"fault",tint:"rgba(213, 40, 27, 0.12)"},over:{text:"over: press Reset",kind:"off",tint:"rgba(93, 104, 117, 0.10)"},failed:{text:"failed: press Reset",kind:"fault",tint:"rgba(213, 40, 27, 0.12)"},limited:{text:"cannot follow",kind:"fault",tint:"rgba(213, 40, 27, 0.12)"},stopped:{text:"stopped",kind:"fault",tint:"rgba(213, 40, 27, 0.12)"}},O1=["lift","guided","land","hold","contact","limited"];function Ah(i){return O1.includes(i)}function Ch(i){return _0[i]}function b0({phase:i,alarm:e}){let{text:t,kind:n}=_0[i];return e.startsWith(t)?{text:e,kind:"fault"}:e?{text:`${t} \xB7 fault: ${e}`,kind:"fault"}:{text:t,kind:n}}var U1=1e4,Rh=class{text=X("p",{id:"refusal",hidden:!0});element=X("div",{class:"refusal-row"},this.text);refusals={lift:"",land:""};pointed=null;asked="lift";until=0;constructor(){this.text.addEventListener("click",()=>{this.until=0,this.show("",!1)})}listen(e,t){let n=s=>{this.pointed=s?t:null,this.update()};e.addEventListener("pointerenter",({pointerType:s})=>n(s==="mouse")),e.addEventListener("focus",()=>n(e.matches(":focus-visible")));for(let s of["pointerleave","blur"])e.addEventListener(s,()=>n(!1))}ask(e){[this.asked,this.until]=[e,0],this.show("",!1)}refused(e){this.until=performance.now()+U1,this.show(e,!0)}status({refusals:e,holder:t}){this.refusals=e,t==="you"&&(this.until=0),this.update()}update(){let e=performance.now()<this.until?this.refusals[this.asked]:"";this.show(e||(this.pointed?this.refusals[this.pointed]:""),e!=="")}show(e,t){let{classList:n}=this.text;this.text.textContent!==e&&(this.text.textContent=e),this.text.hidden=e==="",n.contains("asked")!==t&&(n.toggle("asked",t),this.text.role=t?"alert":null)}};var Ph=class{text=X("span",{role:"status"});button;asks=!0;element;constructor(e){this.button=Tt("hand","","One page at a time has the hand; the others watch",()=>{e({type:"turn",what:this.asks?"ask":"give"})}),this.element=X("div",{class:"strip turns",hidden:!0},this.text,this.button)}status({viewers:e,turns:t}){if(this.element.hidden=!t||e<2&&t.queue.length===0,!t)return;let{text:n,act:s}=k1(t);this.asks=!t.queue.includes(t.number),this.text.textContent!==n&&(this.text.textContent=n);let r=this.button.querySelector("span");r.textContent!==s&&(r.textContent=s)}};function k1({number:i,queue:e}){let[t,...n]=e,s=e.indexOf(i),r=`You are ${i}.`;if(!e.length)return{text:`${r} Nobody has the hand.`,act:"Ask for the hand"};let o=n.length?` Waiting: ${n.join(", ")}.`:"";return s===0?{text:`${r} You have the hand.${o}`,act:n.length?"Give it on":"Give it back"}:{text:`${r} ${t} has the hand.${o}`,act:s<0?"Ask for the hand":"Leave the queue"}}var{min:B1,max:z1}=y0.speed.factor,[S0,M0]=["Lift off (L)","Land here (K)"],V1="Stop all rotors at once: the vehicle falls",G1="Fly a mission of your own: a .toml file, which can also be dropped on the page",w0=[z1,.5,.25,B1].map(String),Lh=class{constructor(e,t,n,s){this.send=t;this.question=n;this.actions=s;this.pauseButton=Tt("pause","Pause","Pause or continue (P)",()=>{this.pause(!this.paused),t({type:"pause",on:this.paused})}),this.enableButton=Tt("hand","","Whether the pilot follows pushes",()=>{this.enable(!this.enabled),t({type:"enable",on:this.enabled})}),this.enable(!0),this.speeds=this.speedChoice(),this.openButton=Tt("open","Open",G1,s.open),this.videoButton=Tt("video","Video","Record a video of the picture",s.film),this.asking={lift:this.request("lift",S0,"go"),land:this.request("land",M0)};let r=Tt("stop","Stop",V1,()=>this.stop(),"danger"),o=Tt("save","Save","Save the flight so far",s.save);this.turns=new Ph(t),e.replaceChildren(this.note.element,this.turns.element,X("div",{class:"strip"},this.asking.lift,this.asking.land,r,this.enableButton),X("div",{class:"strip"},this.pauseButton,this.speeds,this.resetButton()),X("div",{class:"strip"},this.openButton,o,this.videoButton))}send;question;actions;note=new Rh;turns;asking;paused=!1;enabled=!0;airborne=!1;pauseButton;enableButton;speeds;videoButton;openButton;status(e){this.pause(e.paused);let t=String(Number(e.speed.toPrecision(3)));document.activeElement!==this.speeds&&w0.includes(t)&&(this.speeds.value=t),this.enable(e.enabled),this.turns.status(e);let{lift:n,land:s}=e.refusals;T0(this.asking.lift,n,S0),T0(this.asking.land,s,M0),e.paused||this.note.status(e),this.airborne=Ah(e.phase),this.airborne||this.question.withdraw()}ask(e){this.note.ask(e),this.paused&&this.note.refused("The flight is paused. Press Continue, and the pilot is asked."),this.send({type:"ask",what:e})}stop(){let e=()=>this.send({type:"ask",what:"stop"}),t=this.actions.height(),n=t===null?"":` from ${t.toFixed(1)} m`;this.airborne?this.question.ask("Stop all rotors?",`The rotors stop and it falls${n}.`,"Stop",e):e()}refused(e){this.note.refused(e)}togglePause(){this.pauseButton.click()}filming(e){this.videoButton.classList.toggle("filming",e),this.videoButton.querySelector("span").textContent=e?"End video":"Video"}reset(e){this.enable(!0),this.openButton.hidden=!e}pause(e){if(e===this.paused)return;this.paused=e;let[t,n]=e?["play","Continue"]:["pause","Pause"];this.pauseButton.replaceChildren(Gi(t),X("span",{},n))}enable(e){this.enabled=e,this.enableButton.setAttribute("aria-pressed",String(e)),this.enableButton.querySelector("span").textContent=e?"Follows me":"Does not follow"}request(e,t,n){let r=Tt(e,e==="lift"?"Lift":"Land",t,()=>this.ask(e),n);return this.note.listen(r,e),r}speedChoice(){let e=w0.map(s=>X("option",{value:s},`\xD7${s}`)),t="Speed of the flight";return nr({title:t,"aria-label":t},s=>this.send({type:"speed",factor:Number(s)}),!1,e)}resetButton(){return Tt("reset","Reset","Begin the flight again",()=>this.send({type:"reset"}))}};function T0(i,e,t){i.setAttribute("aria-disabled",String(e!=="")),i.title!==(e||t)&&(i.title=e||t)}var H1=[["Drag the beam","pull it"],["Wheel, while dragging","push away or pull near; with a level plane, up or down"]],W1=[["Drag the beam with a finger","pull it"],["Second finger up or down, meanwhile","push away or pull near; with a level plane, up or down"]],X1=["Push, Shake, Tap","pull; shake with the force of the drag as its peak; a push of 50 ms away from you"],q1=["Drag elsewhere \xB7 wheel \xB7 right button","turn the view \xB7 zoom \xB7 shift"],Y1=["Drag elsewhere \xB7 two fingers","turn the view \xB7 zoom and shift"],$1=["Plots: point \xB7 drag or wheel \xB7 double click","values there \xB7 zoom in time \xB7 the last 20 s again"],Z1=["Plots: tap \xB7 two fingers \xB7 double tap","values there \xB7 zoom in time \xB7 the last 20 s again"],K1=["Rewind, below the picture","fly again to the chosen moment, and try again from there"],J1=[["Arrows or W A S D","push level; the force is set under Settings \u2192 Hand"],["E, Q or Page Up, Page Down","push up, down"],["Gamepad","left stick: level; right stick: up and down"],["R \xB7 Ctrl+Z","fly again to the chosen moment, and try again from there \xB7 undo a setting"],["5 6 7 \xB7 L \xB7 K \xB7 P","push, shake, tap \xB7 lift \xB7 land \xB7 pause"]],j1=["T","lecture: full screen, large type, one quantity, the steps of a script"],Q1=[["P","play or pause"],["Left, Right","one second back, on"]],eT=["1 2 3 4 \xB7 F","view from behind, the side, above, on board \xB7 follow the vehicle"],tT=[["best","amber shape","the ghost of a comparison, or your best run in a challenge"],["push","red arrow","true push on the beam; the curved one is its moment about the centre of mass"],["hand","violet hoop","the admittance's threshold: a push whose arrow does not pass it moves nothing"],["hand","violet box and spring","the hand; inside the box a pull is below the threshold and moves nothing"],["thrust","green to red arrows","thrust of each rotor; red is near its maximum"],["front","thrusts: front","rotors ahead of the middle of their quadrotor, left or right: towards +x, a shade for each"],["rear","thrusts: rear","rotors behind the middle of their quadrotor"],["path","blue shape and line","the reference, where the vehicle is off it; the path flown"],["wind","light blue arrow","the wind"]];function nT(i,e){let t=e?W1:H1,n=e?[Y1,Z1]:[q1,$1],s=i?n:[...t,...n,X1];return e?i?s:[...s,K1]:[...s,...i?Q1:J1,eT,j1]}function E0(i){let e=Ke("help"),t=window.matchMedia("(pointer: coarse)").matches,n=nT(i,t).flatMap(([c,h])=>[X("dt",{},c),X("dd",{},h)]),s=tT.flatMap(([c,h,u])=>[X("dt",{},X("i",{class:`dot ${c}`}),h),X("dd",{},u)]),r=X("button",{type:"button",class:"go"},"Close");r.addEventListener("click",()=>e.close());let a=i?[]:[X("p",{},"One page holds the beam at a time. It lets go when it loses the focus or the connection.")],l=[X("h2",{id:"help-title"},i?"A saved flight":"Push the beam yourself"),X("dl",{},...n)];return e.replaceChildren(...l,X("h3",{},"What is shown"),X("dl",{},...s),...a,r),e.addEventListener("click",c=>{c.target===e&&e.close()}),e}var A0=.1,iT={facing:"facing me",level:"level"};function C0(i){let{input:e,force:t}=sT(i),n=Ri("Where the hand pulls",{point:"at the point",centre:"centre of mass"},i.at,l=>{i.at=l}),s=Ri("Plane of the hand",iT,i.plane,l=>{[i.plane,i.planeChosen]=[l,!0]}),o=Ri("Directions of the keys",{view:"as seen",world:"world axes"},i.directions,l=>{i.directions=l});return{rows:[Tr("Pull",n),Tr("Plane",s),Tr("Key, tap force",X("label",{class:"newtons",for:"key-force"},e,"N")),Tr("Keys push",o)],force:t,planes:s}}function R0(i){let e=X("input",{type:"range",min:.5,max:10,step:.5,value:i.frequency,title:"Frequency of the shake"}),t=X("output",{},`${i.frequency} Hz`),n=X("label",{class:"newtons",hidden:!0},e,t);return e.addEventListener("input",()=>{i.frequency=e.valueAsNumber,t.textContent=`${i.frequency} Hz`}),[Ri("What a drag of the beam and a key do",{push:"Push",shake:"Shake",tap:"Tap"},i.kind,r=>{i.kind=r,n.hidden=r!=="shake"}),n]}function sT(i){let e=X("input",{type:"number",min:A0,step:.1,value:i.force,id:"key-force"}),t=()=>{i.force=Math.min(Math.max(e.valueAsNumber||i.force,A0),Number(e.max)),e.value=String(i.force)};return e.addEventListener("input",()=>e.setCustomValidity("")),e.addEventListener("change",()=>{let s=Number.isNaN(e.valueAsNumber);t(),e.setCustomValidity(s?`The force must be a finite number of newtons: it stays ${i.force} N`:""),s&&e.reportValidity()}),{input:e,force:{limit:s=>{e.max=String(s),t()}}}}function Tr(i,e){return X("div",{class:"row"},X("span",{},i),e)}var rT={crashed:"The vehicle has crashed",diverged:"The vehicle is out of control",over:"The flight is over",failed:"The flight has ended by an error"},oT={over:"No flight lasts longer.",failed:"The terminal, or the browser's console, says which."},Ih=class{place=Ke("ended");title=X("b");text=X("span");constructor(e){let t=X("button",{type:"button",class:"go"},"Begin again");t.addEventListener("click",e),this.place.replaceChildren(this.title,this.text,t)}status({phase:e,ending:t,preparing:n}){let s=n?"":rT[e]??"";this.place.hidden=s==="",this.title.textContent!==s&&(this.title.textContent=s);let r=t?.text??oT[e]??"";this.text.textContent!==r&&(this.text.textContent=r)}};var Nh=class{constructor(e){this.notices=e}notices;told=new Map;status(e){e.length===0&&this.told.clear();for(let{kind:t,time:n,text:s}of e)n<(this.told.get(t)??-10)+10||(this.told.set(t,n),this.notices.show(`${n.toFixed(1)} s, ${t}: ${s}`,"finding"))}};var aT=["hold","contact","limited"];function P0({phase:i,preparing:e,refusals:t,holder:n,tare_left_s:s},r){return e?.failure?`The flight cannot be flown: ${e.failure}`:e?`Preparing the flight: ${e.step} \u2026`:s>0&&Ah(i)?`Zeroing the force sensors: do not touch for ${s.toFixed(1)} s`:i==="idle"?t.lift?lT(t):"Press Lift to take off.":aT.includes(i)?n==="none"?t.push:"":i==="guided"&&!r?"Drag the beam to pull it.":""}function lT({lift:i,land:e}){let t=n=>n.slice(n.indexOf(":"));return t(i)===t(e)?"":i}var Ns="ghost ";var Dh=class{constructor(e){this.scene=e;let t=["push","pilot_push","position","reference","disturbance"],n=e.vehicle.quadrotors.flatMap(r=>r.rotors).length,s=["time",...t.flatMap(r=>[0,1,2].map(o=>`${r}${o}`)),...Array.from({length:n},(r,o)=>`thrusts${o}`)];for(let r of[...s,...s.slice(1).map(o=>Ns+o)])this.columns.set(r,new Float64Array(1024))}scene;columns=new Map;length=0;shown=[0,0];continue(e){let{ghost:t}=this.scene,n=e.ghost?.begun!==t?.begun,s=!n&&e.ghost?.swaps!==t?.swaps;return!(s||e.mission===this.scene.mission)||String(e.fields)!==String(this.scene.fields)?!1:(this.scene=e,e.ghost&&n&&this.copyGhost(),s&&this.swapGhost(),!0)}get flown(){let e=this.columns.get("time");return this.length?[e[0],e[this.length-1]]:[NaN,NaN]}add(e){let t=e.scalar("time"),n=t-this.flown[1],s=n>2||n<-1e-4;if(s)this.length=n>0?0:this.index(t);else if(n<1/20-.001)return!1;return this.write(e),s}show([e,t]){this.shown=[Math.max(this.index(e)-1,0),Math.min(this.index(t)+1,this.length)]}column(e){return this.columns.get(e).subarray(...this.shown)}copyGhost(){for(let e of this.ghosts())this.columns.set(e,this.columns.get(e.slice(Ns.length)).slice())}swapGhost(){for(let e of this.ghosts()){let t=e.slice(Ns.length),n=this.columns.get(e);this.columns.set(e,this.columns.get(t)).set(t,n)}}ghosts(){return[...this.columns.keys()].filter(e=>e.startsWith(Ns))}index(e){return Ff(this.columns.get("time").subarray(0,this.length),e)}thin(){for(let e of this.columns.values()){for(let t=0;t<16384/4;t++)e[t]=e[2*t];e.copyWithin(16384/4,16384/2)}this.length=3/4*16384}write(e){this.length===16384&&this.thin();for(let[t,n]of this.columns){let s=this.length<n.length?n:cT(n);s[this.length]=L0(e,t),this.columns.set(t,s)}this.length+=1}};function Ff(i,e){let[t,n]=[0,i.length];for(;t<n;){let s=t+n>>1;i[s]<e?t=s+1:n=s}return t}function cT(i){let e=new Float64Array(2*i.length);return e.set(i),e}function L0(i,e){if(!i)return NaN;if(e==="time")return i.scalar(e);if(e.startsWith(Ns))return L0(i.ghost,e.slice(Ns.length));let t=e.search(/\d+$/),n=e.slice(0,t);return i.layout.has(n)?i.values[i.layout.place(n).start+Number(e.slice(t))]:NaN}var hT=new U(0,1,0),ir=class{constructor(e,t,n,s){this.radius=t;this.scale=n;this.faintest=s;let r=new On({color:e,emissive:e,emissiveIntensity:.35});this.shaft=new ct(new Ei(t,t,1,12),r),this.head=new ct(new Rs(2.6*t,7*t,14),r),this.group.add(this.shaft,this.head),this.group.visible=!1}radius;scale;faintest;group=new At;tip=new U;shaft;head;get visible(){return this.group.visible}show(e,t){let n=new U(...t),s=n.length();if(this.group.visible=s>this.faintest,!this.group.visible)return;let r=s*this.scale,o=Math.min(r/(8*this.radius),1),a=r/o-7*this.radius;this.group.scale.setScalar(o),this.group.position.copy(e),this.group.quaternion.copy(new Dn().setFromUnitVectors(hT,n.divideScalar(s))),this.shaft.scale.y=a,this.shaft.position.y=a/2,this.head.position.y=a+3.5*this.radius,this.tip.copy(e).addScaledVector(n,r)}};var uT=.035,dT=.16,fT=.012,Eo=class{group=new At;constructor(e){let t=new ln({color:e,depthTest:!1,transparent:!0,opacity:.95}),n=[0,Math.PI/2].map(s=>{let r=new ct(new $s(dT,fT,8,32),t);return r.rotation.y=s,r});this.group.add(new ct(new Jn(uT,14,10),t),...n);for(let s of this.group.children)s.renderOrder=9;this.group.visible=!1}hide(){this.group.visible=!1}show(e){this.group.position.copy(e),this.group.visible=!0}};var I0={push:"#d5281b",contact:"#c47a00",moment:"#b4551c",person:"#b3bdc9",hand:"#7a3fb5",path:"#1f5fbf",wind:"#2a93b8",floor:"#d3d7db",pale:"#d9dee2",lane:"#e3e6e9",grid:"#a9b1ba",haze:"#e9edf1",zenith:"#b4cbe1",wall:"#7f8fa3",frame:"#4d5a6b",shade:"#aeb5bd"},N0={push:"#ff5f52",contact:"#ffb938",moment:"#ff9a5c",person:"#76869a",hand:"#c08cff",path:"#6ea8ff",wind:"#4fc3e8",floor:"#262d35",pale:"#20272f",lane:"#303944",grid:"#56626f",haze:"#1d242c",zenith:"#0c1118",wall:"#6f8299",frame:"#9fb0c4",shade:"#11161b"},pT={"#2b2f36":"#5c6672","#5b636e":"#8b95a1"},pt={...I0};function D0(i){Object.assign(pt,i==="dark"?N0:I0)}function Fh(i){return pt.floor===N0.floor?pT[i]??i:i}var mT=.4,Oh=class{group=new At;place=new U;mark=new Eo(pt.contact);arrow=new ir(pt.contact,.018,mT,0);text="";constructor(){this.group.add(this.mark.group,this.arrow.group)}update(e,t){let n=e.scalar("contact_part");return n!==0?this.touch(n,e.vector("contact_point"),e.vector("contact_normal")):t[e.scalar("phase")]!=="contact"&&(this.text=""),this.group.visible=this.text!=="",this.text}touch(e,t,n){this.place.set(...t),this.mark.show(this.place),this.arrow.show(this.place,n),this.text=Of(e)}};function Of(i){return i<0?"the beam touches":`guard ${i} touches`}var gT=.05,vT=.5,xT=400,$a=class{all=[];phases=[];lasting={};strongest=0;frame(e){let t=e.scalar("time");this.phase(t,e.scalar("phase"));let n=Zt(e.vector("push"));n>gT&&this.push(t,n);let s=e.scalar("contact_part");s!==0&&this.goesOn("touch",t,Of(s))}setting(e,t){this.add({kind:"setting",time:e,text:t})}findings(e){let t=({time:n,text:s},r)=>r.time===n&&s.startsWith(`${r.kind}:`);this.all=this.all.filter(n=>n.kind!=="finding"||e.some(s=>t(n,s)));for(let n of e){let s=`${n.kind}: ${n.text}`,r=this.all.find(o=>o.kind==="finding"&&t(o,n));r?r.text=s:this.add({kind:"finding",time:n.time,text:s})}}cut(e){this.all=this.all.filter(n=>n.time<e),this.phases=this.phases.filter(({from:n})=>n<e);let t=this.phases.at(-1);t&&(t.to=Math.min(t.to,e)),delete this.lasting.push,delete this.lasting.touch}phase(e,t){let n=this.phases.at(-1);n&&(n.to=e),n?.phase!==t&&this.phases.push({from:e,to:e,phase:t})}push(e,t){let n=this.goesOn("push",e,"");this.strongest=n.mark.time===e?t:Math.max(this.strongest,t);let s=(e-n.mark.time).toFixed(1);n.mark.text=`push of ${this.strongest.toFixed(1)} N at most, for ${s} s`}goesOn(e,t,n){let s=this.lasting[e];return(!s||t>s.until+vT)&&(s={mark:{kind:e,time:t,text:n},until:t},this.add(s.mark)),s.until=t,this.lasting[e]=s,s}add(e){this.all.push(e),this.all.length>xT&&this.all.shift()}};function O0(i,e=!1){let t=i[0].index!==null,n=new Set(Object.keys(i[0].attributes)),s=new Set(Object.keys(i[0].morphAttributes)),r={},o={},a=i[0].morphTargetsRelative,l=new zt;l.morphTargetsRelative=a;let c=0;for(let h=0;h<i.length;++h){let u=i[h],d=0,f=0;if(t!==(u.index!==null))return console.error("THREE.BufferGeometryUtils: .mergeGeometries() failed with geometry at index "+h+". All geometries must have compatible attributes; make sure index attribute exists among all geometries, or in none of them."),null;for(let m in u.attributes){if(!n.has(m))return console.error("THREE.BufferGeometryUtils: .mergeGeometries() failed with geometry at index "+h+'. All geometries must have compatible attributes; make sure "'+m+'" attribute exists among all geometries, or in none of them.'),null;r[m]===void 0&&(r[m]=[]),r[m].push(u.attributes[m]),d++}if(d!==n.size)return console.error("THREE.BufferGeometryUtils: .mergeGeometries() failed with geometry at index "+h+". Make sure all geometries have the same number of attributes."),null;if(a!==u.morphTargetsRelative)return console.error("THREE.BufferGeometryUtils: .mergeGeometries() failed with geometry at index "+h+". .morphTargetsRelative must be consistent throughout all geometries."),null;for(let m in u.morphAttributes){if(!s.has(m))return console.error("THREE.BufferGeometryUtils: .mergeGeometries() failed with geometry at index "+h+".  .morphAttributes must be consistent throughout all geometries."),null;if(u.morphAttributes[m].length!==i[0].morphAttributes[m].length)return console.error("THREE.BufferGeometryUtils: .mergeGeometries() failed with geometry at index "+h+'. All geometries must have the same number of morph targets for the "'+m+'" morph attribute.'),null;o[m]===void 0&&(o[m]=[]),o[m].push(u.morphAttributes[m]),f++}if(f!==s.size)return console.error("THREE.BufferGeometryUtils: .mergeGeometries() failed with geometry at index "+h+". Make sure all geometries have the same number of morph attributes."),null;if(e){let m;if(t)m=u.index.count;else if(u.attributes.position!==void 0)m=u.attributes.position.count;else return console.error("THREE.BufferGeometryUtils: .mergeGeometries() failed with geometry at index "+h+". The geometry must have either an index or a position attribute"),null;l.addGroup(c,m,h),c+=m}}if(t){let h=0,u=[];for(let d=0;d<i.length;++d){let f=i[d].index;for(let m=0;m<f.count;++m)u.push(f.getX(m)+h);h+=i[d].attributes.position.count}l.setIndex(u)}for(let h in r){let u=F0(r[h]);if(!u)return console.error("THREE.BufferGeometryUtils: .mergeGeometries() failed while trying to merge the "+h+" attribute."),null;l.setAttribute(h,u)}for(let h in o){let u=o[h][0].length;if(u!==0){l.morphAttributes=l.morphAttributes||{},l.morphAttributes[h]=[];for(let d=0;d<u;++d){let f=[];for(let _=0;_<o[h].length;++_)f.push(o[h][_][d]);let m=F0(f);if(!m)return console.error("THREE.BufferGeometryUtils: .mergeGeometries() failed while trying to merge the "+h+" morphAttribute."),null;l.morphAttributes[h].push(m)}}}return l}function F0(i){let e,t,n,s=-1,r=0;for(let c=0;c<i.length;++c){let h=i[c];if(e===void 0&&(e=h.array.constructor),e!==h.array.constructor)return console.error("THREE.BufferGeometryUtils: .mergeAttributes() failed. BufferAttribute.array must be of consistent array types across matching attributes."),null;if(t===void 0&&(t=h.itemSize),t!==h.itemSize)return console.error("THREE.BufferGeometryUtils: .mergeAttributes() failed. BufferAttribute.itemSize must be consistent across matching attributes."),null;if(n===void 0&&(n=h.normalized),n!==h.normalized)return console.error("THREE.BufferGeometryUtils: .mergeAttributes() failed. BufferAttribute.normalized must be consistent across matching attributes."),null;if(s===-1&&(s=h.gpuType),s!==h.gpuType)return console.error("THREE.BufferGeometryUtils: .mergeAttributes() failed. BufferAttribute.gpuType must be consistent across matching attributes."),null;r+=h.count*t}let o=new e(r),a=new Qt(o,t,n),l=0;for(let c=0;c<i.length;++c){let h=i[c];if(h.isInterleavedBufferAttribute){let u=l/t;for(let d=0,f=h.count;d<f;d++)for(let m=0;m<t;m++){let _=h.getComponent(d,m);a.setComponent(d+u,m,_)}}else o.set(h.array,l);l+=h.count*t}return s!==void 0&&(a.gpuType=s),a}function Uf({axes:i,position:e}){let[t,n,s]=[0,3,6].map(r=>new U(...i.slice(r,r+3)));return new dt().makeBasis(t,n,s).setPosition(...e)}function kf(i,e){return Ao(i.map(t=>ST(_T(t,e).applyMatrix4(Uf(t)),t.color)))}function Ao(i){let e=O0(i);for(let t of i)t.dispose();return e}var yT=.025;function _T({kind:i,size:e},t){let n=i!=="box"&&e[0]<yT?Math.max(Math.ceil(t/2),4):t;return i==="box"?new ti(...e):i==="hull"?bT(e):i==="sphere"?new Jn(e[0],n,Math.ceil(n/2)):new Ei(e[0],e[0],e[1],n).rotateX(Math.PI/2)}function bT(i){let e=i.length/3,t=new zt().setAttribute("position",new Mt([...i],3));return t.setAttribute("uv",new Mt(new Float32Array(2*e),2)),t.setIndex([...Array(e).keys()]).computeVertexNormals(),t}function ST(i,e){let{r:t,g:n,b:s}=new qe(Fh(e)),r=Array.from({length:i.getAttribute("position").count},()=>[t,n,s]).flat();return i.setAttribute("color",new Mt(r,3))}var MT=26,U0=.45,k0=.01,[wT,TT]=["#1f9d76","#d5281b"],B0=new U(0,0,1),ET="#e8641b";function kh(i,e){return i.rotors[e].disc.color===ET}var Uh=class{group=new At;arrows=new At;places;blades;discs;shafts;heads;calm=new qe(wT);hard=new qe(TT);constructor(e,t){let n=e.vehicle.quadrotors.flatMap(r=>r.rotors);this.places=n.map(({blades:r,radius:o,spin:a,max_thrust:l})=>({blades:r,still:Uf(r),hub:new U(...r.position),radius:o,spin:a,most:l,angle:0}));let s=t==="full"?12:6;this.blades=this.instances(new ti(1,1,1),new On),this.discs=this.instances(new ya(1,28),Bf(.26,!0)),this.shafts=this.instances(z0(new Ei(1,1,1,s)),Bf(.85)),this.heads=this.instances(z0(new Rs(1,1,s)),Bf(.85)),this.blades.castShadow=t==="full",this.arrows.add(this.shafts,this.heads),this.group.add(this.blades,this.discs,this.arrows),n.forEach(({blades:r,disc:o},a)=>{this.blades.setColorAt(a,new qe(Fh(r.color))),this.discs.setColorAt(a,new qe(o.color))})}update(e,t){this.places.forEach((n,s)=>{let r=Math.min(Math.max((e[s]??0)/n.most,0),1.2);r>k0&&(n.angle-=n.spin*MT*Math.sqrt(r)*t);let o=new dt().makeRotationZ(n.angle);this.blades.setMatrixAt(s,n.still.clone().multiply(o).scale(new U(...n.blades.size)));let a=r>k0?n.radius:0;this.discs.setMatrixAt(s,new dt().makeScale(a,a,a).setPosition(n.hub)),this.arrow(s,n,r)});for(let n of[this.blades,this.discs,this.shafts,this.heads])n.instanceMatrix.needsUpdate=!0;for(let n of[this.shafts,this.heads])n.instanceColor.needsUpdate=!0}arrow(e,{hub:t,radius:n},s){let r=.06*n,o=Math.min(U0*s,.5*n),a=U0*s-o,l=t.clone().addScaledVector(B0,.1*n);this.shafts.setMatrixAt(e,V0(l,r,a)),this.heads.setMatrixAt(e,V0(l.addScaledVector(B0,a),2.6*r,o));let c=this.calm.clone().lerp(this.hard,Math.min(Math.max((s-.6)/.35,0),1));this.shafts.setColorAt(e,c),this.heads.setColorAt(e,c)}instances(e,t){let n=new ma(e,t,this.places.length);return n.frustumCulled=!1,n}};function Bf(i,e=!1){let t=e?Ai:ls;return new ln({transparent:!0,opacity:i,depthWrite:!1,side:t,forceSinglePass:!0})}function z0(i){return i.rotateX(Math.PI/2).translate(0,0,.5)}function V0(i,e,t){return new dt().makeScale(e,e,Math.max(t,1e-4)).setPosition(i)}var AT="uplot",CT="u-hz",RT="u-vt",PT="u-title",LT="u-wrap",IT="u-under",NT="u-over",DT="u-axis",Cr="u-off",FT="u-select",OT="u-cursor-x",UT="u-cursor-y",kT="u-cursor-pt",BT="u-legend",zT="u-live",VT="u-inline",GT="u-series",HT="u-marker",G0="u-label",WT="u-value",Ka="width",Ja="height";var H0="bottom",Co="left",zf="right",ip="#000",W0=ip+"0",Vf="mousemove",X0="mousedown",Gf="mouseup",q0="mouseenter",Y0="mouseleave",$0="dblclick",XT="resize",qT="scroll",Z0="change",Hh="dppxchange",sp="--",Fo=typeof window<"u",Yf=Fo?document:null,Po=Fo?window:null,YT=Fo?navigator:null,Pt,Bh;function $f(){let i=devicePixelRatio;Pt!=i&&(Pt=i,Bh&&Kf(Z0,Bh,$f),Bh=matchMedia(`(min-resolution: ${Pt-.001}dppx) and (max-resolution: ${Pt+.001}dppx)`),Rr(Z0,Bh,$f),Po.dispatchEvent(new CustomEvent(Hh)))}function xi(i,e){if(e!=null){let t=i.classList;!t.contains(e)&&t.add(e)}}function Zf(i,e){let t=i.classList;t.contains(e)&&t.remove(e)}function Kt(i,e,t){i.style[e]=t+"px"}function Hi(i,e,t,n){let s=Yf.createElement(i);return e!=null&&xi(s,e),t?.insertBefore(s,n),s}function Pi(i,e){return Hi("div",i,e)}var K0=new WeakMap;function ds(i,e,t,n,s){let r="translate("+e+"px,"+t+"px)",o=K0.get(i);r!=o&&(i.style.transform=r,K0.set(i,r),e<0||t<0||e>n||t>s?xi(i,Cr):Zf(i,Cr))}var J0=new WeakMap;function j0(i,e,t){let n=e+t,s=J0.get(i);n!=s&&(J0.set(i,n),i.style.background=e,i.style.borderColor=t)}var Q0=new WeakMap;function ev(i,e,t,n){let s=e+""+t,r=Q0.get(i);s!=r&&(Q0.set(i,s),i.style.height=t+"px",i.style.width=e+"px",i.style.marginLeft=n?-e/2+"px":0,i.style.marginTop=n?-t/2+"px":0)}var rp={passive:!0},$T={...rp,capture:!0};function Rr(i,e,t,n){e.addEventListener(i,t,n?$T:rp)}function Kf(i,e,t,n){e.removeEventListener(i,t,rp)}Fo&&$f();function Wi(i,e,t,n){let s;t=t||0,n=n||e.length-1;let r=n<=2147483647;for(;n-t>1;)s=r?t+n>>1:yi((t+n)/2),e[s]<i?t=s:n=s;return i-e[t]<=e[n]-i?t:n}function Cv(i){return(t,n,s)=>{let r=-1,o=-1;for(let a=n;a<=s;a++)if(i(t[a])){r=a;break}for(let a=s;a>=n;a--)if(i(t[a])){o=a;break}return[r,o]}}var Rv=i=>i!=null,Pv=i=>i!=null&&i>0,qh=Cv(Rv),ZT=Cv(Pv);function KT(i,e,t,n=0,s=!1){let r=s?ZT:qh,o=s?Pv:Rv;[e,t]=r(i,e,t);let a=i[e],l=i[e];if(e>-1)if(n==1)a=i[e],l=i[t];else if(n==-1)a=i[t],l=i[e];else for(let c=e;c<=t;c++){let h=i[c];o(h)&&(h<a?a=h:h>l&&(l=h))}return[a??Vt,l??-Vt]}function Yh(i,e,t,n){let s=iv(i),r=iv(e);i==e&&(s==-1?(i*=t,e/=t):(i/=t,e*=t));let o=t==10?Ds:Lv,a=s==1?yi:Li,l=r==1?Li:yi,c=a(o(wn(i))),h=l(o(wn(e))),u=Lo(t,c),d=Lo(t,h);return t==10&&(c<0&&(u=Gt(u,-c)),h<0&&(d=Gt(d,-h))),n||t==2?(i=u*s,e=d*r):(i=Fv(i,u),e=$h(e,d)),[i,e]}function op(i,e,t,n){let s=Yh(i,e,t,n);return i==0&&(s[0]=0),e==0&&(s[1]=0),s}var ap=.1,tv={mode:3,pad:ap},Qa={pad:0,soft:null,mode:0},JT={min:Qa,max:Qa};function Wh(i,e,t,n){return Zh(t)?nv(i,e,t):(Qa.pad=t,Qa.soft=n?0:null,Qa.mode=n?3:0,nv(i,e,JT))}function Ct(i,e){return i??e}function jT(i,e,t){for(e=Ct(e,0),t=Ct(t,i.length-1);e<=t;){if(i[e]!=null)return!0;e++}return!1}function nv(i,e,t){let n=t.min,s=t.max,r=Ct(n.pad,0),o=Ct(s.pad,0),a=Ct(n.hard,-Vt),l=Ct(s.hard,Vt),c=Ct(n.soft,Vt),h=Ct(s.soft,-Vt),u=Ct(n.mode,0),d=Ct(s.mode,0),f=e-i,m=Ds(f),_=Qn(wn(i),wn(e)),g=Ds(_),p=wn(g-m);(f<1e-24||p>10)&&(f=0,(i==0||e==0)&&(f=1e-24,u==2&&c!=Vt&&(r=0),d==2&&h!=-Vt&&(o=0)));let y=f||_||1e3,A=Ds(y),S=Lo(10,yi(A)),P=y*(f==0?i==0?.1:1:r),E=Gt(Fv(i-P,S/10),24),x=i>=c&&(u==1||u==3&&E<=c||u==2&&E>=c)?c:Vt,T=Qn(a,E<x&&i>=x?x:Xi(x,E)),k=y*(f==0?e==0?.1:1:o),D=Gt($h(e+k,S/10),24),N=e<=h&&(d==1||d==3&&D>=h||d==2&&D<=h)?h:-Vt,z=Xi(l,D>N&&e<=N?N:Qn(N,D));return T==z&&T==0&&(z=100),[T,z]}var QT=new Intl.NumberFormat(Fo?YT.language:"en-US"),lp=i=>QT.format(i),_i=Math,Gh=_i.PI,wn=_i.abs,yi=_i.floor,Mn=_i.round,Li=_i.ceil,Xi=_i.min,Qn=_i.max,Lo=_i.pow,iv=_i.sign,Ds=_i.log10,Lv=_i.log2,eE=(i,e=1)=>_i.sinh(i)*e,Hf=(i,e=1)=>_i.asinh(i/e),Vt=1/0;function sv(i){return(Ds((i^i>>31)-(i>>31))|0)+1}function Jf(i,e,t){return Xi(Qn(i,e),t)}function Iv(i){return typeof i=="function"}function St(i){return Iv(i)?i:()=>i}var tE=()=>{},Nv=i=>i,Dv=(i,e)=>e,nE=i=>null,rv=i=>!0,ov=(i,e)=>i==e,iE=/\.\d*?(?=9{6,}|0{6,})/gm,Pr=i=>{if(Uv(i)||rr.has(i))return i;let e=`${i}`,t=e.match(iE);if(t==null)return i;let n=t[0].length-1;if(e.indexOf("e-")!=-1){let[s,r]=e.split("e");return+`${Pr(s)}e${r}`}return Gt(i,n)};function Er(i,e){return Pr(Gt(Pr(i/e))*e)}function $h(i,e){return Pr(Li(Pr(i/e))*e)}function Fv(i,e){return Pr(yi(Pr(i/e))*e)}function Gt(i,e=0){if(Uv(i))return i;let t=10**e,n=i*t*(1+Number.EPSILON);return Mn(n)/t}var rr=new Map;function Ov(i){return((""+i).split(".")[1]||"").length}function tl(i,e,t,n){let s=[],r=n.map(Ov);for(let o=e;o<t;o++){let a=wn(o),l=Gt(Lo(i,o),a);for(let c=0;c<n.length;c++){let h=i==10?+`${n[c]}e${o}`:n[c]*l,u=(o>=0?0:a)+(o>=r[c]?0:r[c]),d=i==10?h:Gt(h,u);s.push(d),rr.set(d,u)}}return s}var el={},cp=[],Io=[null,null],sr=Array.isArray,Uv=Number.isInteger,sE=i=>i===void 0;function av(i){return typeof i=="string"}function Zh(i){let e=!1;if(i!=null){let t=i.constructor;e=t==null||t==Object}return e}function rE(i){return i!=null&&typeof i=="object"}var oE=Object.getPrototypeOf(Uint8Array),kv="__proto__";function No(i,e=Zh){let t;if(sr(i)){let n=i.find(s=>s!=null);if(sr(n)||e(n)){t=Array(i.length);for(let s=0;s<i.length;s++)t[s]=No(i[s],e)}else t=i.slice()}else if(i instanceof oE)t=i.slice();else if(e(i)){t={};for(let n in i)n!=kv&&(t[n]=No(i[n],e))}else t=i;return t}function xn(i){let e=arguments;for(let t=1;t<e.length;t++){let n=e[t];for(let s in n)s!=kv&&(Zh(i[s])?xn(i[s],No(n[s])):i[s]=No(n[s]))}return i}var aE=0,lE=1,cE=2;function hE(i,e,t){for(let n=0,s,r=-1;n<e.length;n++){let o=e[n];if(o>r){for(s=o-1;s>=0&&i[s]==null;)i[s--]=null;for(s=o+1;s<t&&i[s]==null;)i[r=s++]=null}}}function uE(i,e){if(pE(i)){let o=i[0].slice();for(let a=1;a<i.length;a++)o.push(...i[a].slice(1));return mE(o[0])||(o=fE(o)),o}let t=new Set;for(let o=0;o<i.length;o++){let l=i[o][0],c=l.length;for(let h=0;h<c;h++)t.add(l[h])}let n=[Array.from(t).sort((o,a)=>o-a)],s=n[0].length,r=new Map;for(let o=0;o<s;o++)r.set(n[0][o],o);for(let o=0;o<i.length;o++){let a=i[o],l=a[0];for(let c=1;c<a.length;c++){let h=a[c],u=Array(s).fill(void 0),d=e?e[o][c]:lE,f=[];for(let m=0;m<h.length;m++){let _=h[m],g=r.get(l[m]);_===null?d!=aE&&(u[g]=_,d==cE&&f.push(g)):u[g]=_}hE(u,f,s),n.push(u)}}return n}var dE=typeof queueMicrotask>"u"?i=>Promise.resolve().then(i):queueMicrotask;function fE(i){let e=i[0],t=e.length,n=Array(t);for(let r=0;r<n.length;r++)n[r]=r;n.sort((r,o)=>e[r]-e[o]);let s=[];for(let r=0;r<i.length;r++){let o=i[r],a=Array(t);for(let l=0;l<t;l++)a[l]=o[n[l]];s.push(a)}return s}function pE(i){let e=i[0][0],t=e.length;for(let n=1;n<i.length;n++){let s=i[n][0];if(s.length!=t)return!1;if(s!=e){for(let r=0;r<t;r++)if(s[r]!=e[r])return!1}}return!0}function mE(i,e=100){let t=i.length;if(t<=1)return!0;let n=0,s=t-1;for(;n<=s&&i[n]==null;)n++;for(;s>=n&&i[s]==null;)s--;if(s<=n)return!0;let r=Qn(1,yi((s-n+1)/e));for(let o=i[n],a=n+r;a<=s;a+=r){let l=i[a];if(l!=null){if(l<=o)return!1;o=l}}return!0}var Bv=["January","February","March","April","May","June","July","August","September","October","November","December"],zv=["Sunday","Monday","Tuesday","Wednesday","Thursday","Friday","Saturday"];function Vv(i){return i.slice(0,3)}var gE=zv.map(Vv),vE=Bv.map(Vv),xE={MMMM:Bv,MMM:vE,WWWW:zv,WWW:gE};function Za(i){return(i<10?"0":"")+i}function yE(i){return(i<10?"00":i<100?"0":"")+i}var _E={YYYY:i=>i.getFullYear(),YY:i=>(i.getFullYear()+"").slice(2),MMMM:(i,e)=>e.MMMM[i.getMonth()],MMM:(i,e)=>e.MMM[i.getMonth()],MM:i=>Za(i.getMonth()+1),M:i=>i.getMonth()+1,DD:i=>Za(i.getDate()),D:i=>i.getDate(),WWWW:(i,e)=>e.WWWW[i.getDay()],WWW:(i,e)=>e.WWW[i.getDay()],HH:i=>Za(i.getHours()),H:i=>i.getHours(),h:i=>{let e=i.getHours();return e==0?12:e>12?e-12:e},AA:i=>i.getHours()>=12?"PM":"AM",aa:i=>i.getHours()>=12?"pm":"am",a:i=>i.getHours()>=12?"p":"a",mm:i=>Za(i.getMinutes()),m:i=>i.getMinutes(),ss:i=>Za(i.getSeconds()),s:i=>i.getSeconds(),fff:i=>yE(i.getMilliseconds())};function hp(i,e){e=e||xE;let t=[],n=/\{([a-z]+)\}|[^{]+/gi,s;for(;s=n.exec(i);)t.push(s[0][0]=="{"?_E[s[1]]:s[0]);return r=>{let o="";for(let a=0;a<t.length;a++)o+=typeof t[a]=="string"?t[a]:t[a](r,e);return o}}var bE=new Intl.DateTimeFormat().resolvedOptions().timeZone;function SE(i,e){let t;return e=="UTC"||e=="Etc/UTC"?t=new Date(+i+i.getTimezoneOffset()*6e4):e==bE?t=i:(t=new Date(i.toLocaleString("en-US",{timeZone:e})),t.setMilliseconds(i.getMilliseconds())),t}var Gv=i=>i%1==0,Xh=[1,2,2.5,5],ME=tl(10,-32,0,Xh),Hv=tl(10,0,32,Xh),wE=Hv.filter(Gv),Ar=ME.concat(Hv),up=`
`,Wv="{YYYY}",lv=up+Wv,Xv="{M}/{D}",ja=up+Xv,zh=ja+"/{YY}",qv="{aa}",TE="{h}:{mm}",Ro=TE+qv,cv=up+Ro,hv=":{ss}",Nt=null;function Yv(i){let e=i*1e3,t=e*60,n=t*60,s=n*24,r=s*30,o=s*365,l=(i==1?tl(10,0,3,Xh).filter(Gv):tl(10,-3,0,Xh)).concat([e,e*5,e*10,e*15,e*30,t,t*5,t*10,t*15,t*30,n,n*2,n*3,n*4,n*6,n*8,n*12,s,s*2,s*3,s*4,s*5,s*6,s*7,s*8,s*9,s*10,s*15,r,r*2,r*3,r*4,r*6,o,o*2,o*5,o*10,o*25,o*50,o*100]),c=[[o,Wv,Nt,Nt,Nt,Nt,Nt,Nt,1],[s*28,"{MMM}",lv,Nt,Nt,Nt,Nt,Nt,1],[s,Xv,lv,Nt,Nt,Nt,Nt,Nt,1],[n,"{h}"+qv,zh,Nt,ja,Nt,Nt,Nt,1],[t,Ro,zh,Nt,ja,Nt,Nt,Nt,1],[e,hv,zh+" "+Ro,Nt,ja+" "+Ro,Nt,cv,Nt,1],[i,hv+".{fff}",zh+" "+Ro,Nt,ja+" "+Ro,Nt,cv,Nt,1]];function h(u){return(d,f,m,_,g,p)=>{let y=[],A=g>=o,S=g>=r&&g<o,P=u(m),E=Gt(P*i,3),x=Wf(P.getFullYear(),A?0:P.getMonth(),S||A?1:P.getDate()),T=Gt(x*i,3);if(S||A){let k=S?g/r:0,D=A?g/o:0,N=E==T?E:Gt(Wf(x.getFullYear()+D,x.getMonth()+k,1)*i,3),z=new Date(Mn(N/i)),H=z.getFullYear(),I=z.getMonth();for(let W=0;N<=_;W++){let $=Wf(H+D*W,I+k*W,1),G=$-u(Gt($*i,3));N=Gt((+$+G)*i,3),N<=_&&y.push(N)}}else{let k=g>=s?s:g,D=yi(m)-yi(E),N=T+D+$h(E-T,k);y.push(N);let z=u(N),H=z.getHours()+z.getMinutes()/t+z.getSeconds()/n,I=g/n,W=d.axes[f]._space,$=p/W;for(;N=Gt(N+g,i==1?0:3),!(N>_);)if(I>1){let G=yi(Gt(H+I,6))%24,Q=u(N).getHours()-G;Q>1&&(Q=-1),N-=Q*n,H=(H+I)%24;let se=y[y.length-1];Gt((N-se)/g,3)*$>=.7&&y.push(N)}else y.push(N)}return y}}return[l,c,h]}var[EE,AE,CE]=Yv(1),[RE,PE,LE]=Yv(.001);tl(2,-53,53,[1]);function uv(i,e){return i.map(t=>t.map((n,s)=>s==0||s==8||n==null?n:e(s==1||t[8]==0?n:t[1]+n)))}function dv(i,e){return(t,n,s,r,o)=>{let a=e.find(m=>o>=m[0])||e[e.length-1],l,c,h,u,d,f;return n.map(m=>{let _=i(m),g=_.getFullYear(),p=_.getMonth(),y=_.getDate(),A=_.getHours(),S=_.getMinutes(),P=_.getSeconds(),E=g!=l&&a[2]||p!=c&&a[3]||y!=h&&a[4]||A!=u&&a[5]||S!=d&&a[6]||P!=f&&a[7]||a[1];return l=g,c=p,h=y,u=A,d=S,f=P,E(_)})}}function IE(i,e){let t=hp(e);return(n,s,r,o,a)=>s.map(l=>t(i(l)))}function Wf(i,e,t){return new Date(i,e,t)}function fv(i,e){return e(i)}var NE="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function pv(i,e){return(t,n,s,r)=>r==null?sp:e(i(n))}function DE(i,e){let t=i.series[e];return t.width?t.stroke(i,e):t.points.width?t.points.stroke(i,e):null}function FE(i,e){return i.series[e].fill(i,e)}var OE={show:!0,live:!0,isolate:!1,mount:tE,markers:{show:!0,width:2,stroke:DE,fill:FE,dash:"solid"},idx:null,idxs:null,values:[]};function UE(i,e){let t=i.cursor.points,n=Pi(),s=t.size(i,e);Kt(n,Ka,s),Kt(n,Ja,s);let r=s/-2;Kt(n,"marginLeft",r),Kt(n,"marginTop",r);let o=t.width(i,e,s);return o&&Kt(n,"borderWidth",o),n}function kE(i,e){let t=i.series[e].points;return t._fill||t._stroke}function BE(i,e){let t=i.series[e].points;return t._stroke||t._fill}function zE(i,e){return i.series[e].points.size}var Xf=[0,0];function VE(i,e,t){return Xf[0]=e,Xf[1]=t,Xf}function Vh(i,e,t,n=!0){return s=>{s.button==0&&(!n||s.target==e)&&t(s)}}function qf(i,e,t,n=!0){return s=>{(!n||s.target==e)&&t(s)}}var GE={show:!0,x:!0,y:!0,lock:!1,move:VE,points:{one:!1,show:UE,size:zE,width:0,stroke:BE,fill:kE},bind:{mousedown:Vh,mouseup:Vh,click:Vh,dblclick:Vh,mousemove:qf,mouseleave:qf,mouseenter:qf},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(i,e)=>{e.stopPropagation(),e.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(i,e,t,n,s)=>n-s,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},$v={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},dp=xn({},$v,{filter:Dv}),Zv=xn({},dp,{size:10}),Kv=xn({},$v,{show:!1}),fp='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',Jv="bold "+fp,jv=1.5,mv={show:!0,scale:"x",stroke:ip,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Jv,side:2,grid:dp,ticks:Zv,border:Kv,font:fp,lineGap:jv,rotate:0},HE="Value",WE="Time",gv={show:!0,scale:"x",auto:!1,sorted:1,min:Vt,max:-Vt,idxs:[]};function XE(i,e,t,n,s){return e.map(r=>r==null?"":lp(r))}function qE(i,e,t,n,s,r,o){let a=[],l=rr.get(s)||0;t=o?t:Gt($h(t,s),l);for(let c=t;c<=n;c=Gt(c+s,l))a.push(Object.is(c,-0)?0:c);return a}function jf(i,e,t,n,s,r,o){let a=[],l=i.scales[i.axes[e].scale].log,c=l==10?Ds:Lv,h=yi(c(t));s=Lo(l,h),l==10&&(s=Ar[Wi(s,Ar)]);let u=t,d=s*l;l==10&&(d=Ar[Wi(d,Ar)]);do a.push(u),u=u+s,l==10&&!rr.has(u)&&(u=Gt(u,rr.get(s))),u>=d&&(s=u,d=s*l,l==10&&(d=Ar[Wi(d,Ar)]));while(u<=n);return a}function YE(i,e,t,n,s,r,o){let l=i.scales[i.axes[e].scale].asinh,c=n>l?jf(i,e,Qn(l,t),n,s):[l],h=n>=0&&t<=0?[0]:[];return(t<-l?jf(i,e,Qn(l,-n),-t,s):[l]).reverse().map(d=>-d).concat(h,c)}var Qv=/./,$E=/[12357]/,ZE=/[125]/,vv=/1/,Qf=(i,e,t,n)=>i.map((s,r)=>e==4&&s==0||r%n==0&&t.test(s.toExponential()[s<0?1:0])?s:null);function KE(i,e,t,n,s){let r=i.axes[t],o=r.scale,a=i.scales[o],l=i.valToPos,c=r._space,h=l(10,o),u=l(9,o)-h>=c?Qv:l(7,o)-h>=c?$E:l(5,o)-h>=c?ZE:vv;if(u==vv){let d=wn(l(1,o)-h);if(d<c)return Qf(e.slice().reverse(),a.distr,u,Li(c/d)).reverse()}return Qf(e,a.distr,u,1)}function JE(i,e,t,n,s){let r=i.axes[t],o=r.scale,a=r._space,l=i.valToPos,c=wn(l(1,o)-l(2,o));return c<a?Qf(e.slice().reverse(),3,Qv,Li(a/c)).reverse():e}function jE(i,e,t,n){return n==null?sp:e==null?"":lp(e)}var xv={show:!0,scale:"y",stroke:ip,space:30,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Jv,side:3,grid:dp,ticks:Zv,border:Kv,font:fp,lineGap:jv,rotate:0};function QE(i,e){let t=3+(i||1)*2;return Gt(t*e,3)}function eA(i,e){let{scale:t,idxs:n}=i.series[0],s=i._data[0],r=i.valToPos(s[n[0]],t,!0),o=i.valToPos(s[n[1]],t,!0),a=wn(o-r),l=i.series[e],c=a/(l.points.space*Pt);return n[1]-n[0]<=c}var yv={scale:null,auto:!0,sorted:0,min:Vt,max:-Vt},ex=(i,e,t,n,s)=>s,_v={show:!0,auto:!0,sorted:0,gaps:ex,alpha:1,facets:[xn({},yv,{scale:"x"}),xn({},yv,{scale:"y"})]},bv={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:ex,alpha:1,points:{show:eA,filter:null},values:null,min:Vt,max:-Vt,idxs:[],path:null,clip:null};function tA(i,e,t,n,s){return t/10}var tx={time:!0,auto:!0,distr:1,log:10,asinh:1,min:null,max:null,dir:1,ori:0},nA=xn({},tx,{time:!1,ori:1}),Sv={};function nx(i,e){let t=Sv[i];return t||(t={key:i,plots:[],sub(n){t.plots.push(n)},unsub(n){t.plots=t.plots.filter(s=>s!=n)},pub(n,s,r,o,a,l,c){for(let h=0;h<t.plots.length;h++)t.plots[h]!=s&&t.plots[h].pub(n,s,r,o,a,l,c)}},i!=null&&(Sv[i]=t)),t}var Do=1,ep=2;function Lr(i,e,t){let n=i.mode,s=i.series[e],r=n==2?i._data[e]:i._data,o=i.scales,a=i.bbox,l=r[0],c=n==2?r[1]:r[e],h=n==2?o[s.facets[0].scale]:o[i.series[0].scale],u=n==2?o[s.facets[1].scale]:o[s.scale],d=a.left,f=a.top,m=a.width,_=a.height,g=i.valToPosH,p=i.valToPosV;return h.ori==0?t(s,l,c,h,u,g,p,d,f,m,_,Jh,Oo,Qh,sx,ox):t(s,l,c,h,u,p,g,f,d,_,m,jh,Uo,gp,rx,ax)}function pp(i,e){let t=0,n=0,s=Ct(i.bands,cp);for(let r=0;r<s.length;r++){let o=s[r];o.series[0]==e?t=o.dir:o.series[1]==e&&(o.dir==1?n|=1:n|=2)}return[t,n==1?-1:n==2?1:n==3?2:0]}function iA(i,e,t,n,s){let r=i.mode,o=i.series[e],a=r==2?o.facets[1].scale:o.scale,l=i.scales[a];return s==-1?l.min:s==1?l.max:l.distr==3?l.dir==1?l.min:l.max:0}function Fs(i,e,t,n,s,r){return Lr(i,e,(o,a,l,c,h,u,d,f,m,_,g)=>{let p=o.pxRound,y=c.dir*(c.ori==0?1:-1),A=c.ori==0?Oo:Uo,S,P;y==1?(S=t,P=n):(S=n,P=t);let E=p(u(a[S],c,_,f)),x=p(d(l[S],h,g,m)),T=p(u(a[P],c,_,f)),k=p(d(r==1?h.max:h.min,h,g,m)),D=new Path2D(s);return A(D,T,k),A(D,E,k),A(D,E,x),D})}function Kh(i,e,t,n,s,r){let o=null;if(i.length>0){o=new Path2D;let a=e==0?Qh:gp,l=t;for(let u=0;u<i.length;u++){let d=i[u];if(d[1]>d[0]){let f=d[0]-l;f>0&&a(o,l,n,f,n+r),l=d[1]}}let c=t+s-l,h=10;c>0&&a(o,l,n-h/2,c,n+r+h)}return o}function sA(i,e,t){let n=i[i.length-1];n&&n[0]==e?n[1]=t:i.push([e,t])}function mp(i,e,t,n,s,r,o){let a=[],l=i.length;for(let c=s==1?t:n;c>=t&&c<=n;c+=s)if(e[c]===null){let u=c,d=c;if(s==1)for(;++c<=n&&e[c]===null;)d=c;else for(;--c>=t&&e[c]===null;)d=c;let f=r(i[u]),m=d==u?f:r(i[d]),_=u-s;f=o<=0&&_>=0&&_<l?r(i[_]):f;let p=d+s;m=o>=0&&p>=0&&p<l?r(i[p]):m,m>=f&&a.push([f,m])}return a}function Mv(i){return i==0?Nv:i==1?Mn:e=>Er(e,i)}function ix(i){let e=i==0?Jh:jh,t=i==0?(s,r,o,a,l,c)=>{s.arcTo(r,o,a,l,c)}:(s,r,o,a,l,c)=>{s.arcTo(o,r,l,a,c)},n=i==0?(s,r,o,a,l)=>{s.rect(r,o,a,l)}:(s,r,o,a,l)=>{s.rect(o,r,l,a)};return(s,r,o,a,l,c=0,h=0)=>{c==0&&h==0?n(s,r,o,a,l):(c=Xi(c,a/2,l/2),h=Xi(h,a/2,l/2),e(s,r+c,o),t(s,r+a,o,r+a,o+l,c),t(s,r+a,o+l,r,o+l,h),t(s,r,o+l,r,o,h),t(s,r,o,r+a,o,c),s.closePath())}}var Jh=(i,e,t)=>{i.moveTo(e,t)},jh=(i,e,t)=>{i.moveTo(t,e)},Oo=(i,e,t)=>{i.lineTo(e,t)},Uo=(i,e,t)=>{i.lineTo(t,e)},Qh=ix(0),gp=ix(1),sx=(i,e,t,n,s,r)=>{i.arc(e,t,n,s,r)},rx=(i,e,t,n,s,r)=>{i.arc(t,e,n,s,r)},ox=(i,e,t,n,s,r,o)=>{i.bezierCurveTo(e,t,n,s,r,o)},ax=(i,e,t,n,s,r,o)=>{i.bezierCurveTo(t,e,s,n,o,r)};function lx(i){return(e,t,n,s,r)=>Lr(e,t,(o,a,l,c,h,u,d,f,m,_,g)=>{let{pxRound:p,points:y}=o,A,S;c.ori==0?(A=Jh,S=sx):(A=jh,S=rx);let P=Gt(y.width*Pt,3),E=(y.size-y.width)/2*Pt,x=Gt(E*2,3),T=new Path2D,k=new Path2D,{left:D,top:N,width:z,height:H}=e.bbox;Qh(k,D-x,N-x,z+x*2,H+x*2);let I=W=>{if(l[W]!=null){let $=p(u(a[W],c,_,f)),G=p(d(l[W],h,g,m));A(T,$+E,G),S(T,$,G,E,0,Gh*2)}};if(r)r.forEach(I);else for(let W=n;W<=s;W++)I(W);return{stroke:P>0?T:null,fill:T,clip:k,flags:Do|ep}})}function cx(i){return(e,t,n,s,r,o)=>{n!=s&&(r!=n&&o!=n&&i(e,t,n),r!=s&&o!=s&&i(e,t,s),i(e,t,o))}}var rA=cx(Oo),oA=cx(Uo);function hx(i){let e=Ct(i?.alignGaps,0);return(t,n,s,r)=>Lr(t,n,(o,a,l,c,h,u,d,f,m,_,g)=>{[s,r]=qh(l,s,r);let p=o.pxRound,y=H=>p(u(H,c,_,f)),A=H=>p(d(H,h,g,m)),S,P;c.ori==0?(S=Oo,P=rA):(S=Uo,P=oA);let E=c.dir*(c.ori==0?1:-1),x={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:Do},T=x.stroke,k=!1;if(r-s>=_*4){let H=ue=>t.posToVal(ue,c.key,!0),I=null,W=null,$,G,ce,J=y(a[E==1?s:r]),Q=y(a[s]),se=y(a[r]),de=H(E==1?Q+1:se-1);for(let ue=E==1?s:r;ue>=s&&ue<=r;ue+=E){let ee=a[ue],xe=(E==1?ee<de:ee>de)?J:y(ee),Ae=l[ue];xe==J?Ae!=null?(G=Ae,I==null?(S(T,xe,A(G)),$=I=W=G):G<I?I=G:G>W&&(W=G)):Ae===null&&(k=!0):(I!=null&&P(T,J,A(I),A(W),A($),A(G)),Ae!=null?(G=Ae,S(T,xe,A(G)),I=W=$=G):(I=W=null,Ae===null&&(k=!0)),J=xe,de=H(J+E))}I!=null&&I!=W&&ce!=J&&P(T,J,A(I),A(W),A($),A(G))}else for(let H=E==1?s:r;H>=s&&H<=r;H+=E){let I=l[H];I===null?k=!0:I!=null&&S(T,y(a[H]),A(I))}let[N,z]=pp(t,n);if(o.fill!=null||N!=0){let H=x.fill=new Path2D(T),I=o.fillTo(t,n,o.min,o.max,N),W=A(I),$=y(a[s]),G=y(a[r]);E==-1&&([G,$]=[$,G]),S(H,G,W),S(H,$,W)}if(!o.spanGaps){let H=[];k&&H.push(...mp(a,l,s,r,E,y,e)),x.gaps=H=o.gaps(t,n,s,r,H),x.clip=Kh(H,c.ori,f,m,_,g)}return z!=0&&(x.band=z==2?[Fs(t,n,s,r,T,-1),Fs(t,n,s,r,T,1)]:Fs(t,n,s,r,T,z)),x})}function aA(i){let e=Ct(i.align,1),t=Ct(i.ascDesc,!1),n=Ct(i.alignGaps,0),s=Ct(i.extend,!1);return(r,o,a,l)=>Lr(r,o,(c,h,u,d,f,m,_,g,p,y,A)=>{[a,l]=qh(u,a,l);let S=c.pxRound,{left:P,width:E}=r.bbox,x=Q=>S(m(Q,d,y,g)),T=Q=>S(_(Q,f,A,p)),k=d.ori==0?Oo:Uo,D={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:Do},N=D.stroke,z=d.dir*(d.ori==0?1:-1),H=T(u[z==1?a:l]),I=x(h[z==1?a:l]),W=I,$=I;s&&e==-1&&($=P,k(N,$,H)),k(N,I,H);for(let Q=z==1?a:l;Q>=a&&Q<=l;Q+=z){let se=u[Q];if(se==null)continue;let de=x(h[Q]),ue=T(se);e==1?k(N,de,H):k(N,W,ue),k(N,de,ue),H=ue,W=de}let G=W;s&&e==1&&(G=P+E,k(N,G,H));let[ce,J]=pp(r,o);if(c.fill!=null||ce!=0){let Q=D.fill=new Path2D(N),se=c.fillTo(r,o,c.min,c.max,ce),de=T(se);k(Q,G,de),k(Q,$,de)}if(!c.spanGaps){let Q=[];Q.push(...mp(h,u,a,l,z,x,n));let se=c.width*Pt/2,de=t||e==1?se:-se,ue=t||e==-1?-se:se;Q.forEach(ee=>{ee[0]+=de,ee[1]+=ue}),D.gaps=Q=c.gaps(r,o,a,l,Q),D.clip=Kh(Q,d.ori,g,p,y,A)}return J!=0&&(D.band=J==2?[Fs(r,o,a,l,N,-1),Fs(r,o,a,l,N,1)]:Fs(r,o,a,l,N,J)),D})}function wv(i,e,t,n,s,r,o=Vt){if(i.length>1){let a=null;for(let l=0,c=1/0;l<i.length;l++)if(e[l]!==void 0){if(a!=null){let h=wn(i[l]-i[a]);h<c&&(c=h,o=wn(t(i[l],n,s,r)-t(i[a],n,s,r)))}a=l}}return o}function lA(i){i=i||el;let e=Ct(i.size,[.6,Vt,1]),t=i.align||0,n=i.gap||0,s=i.radius;s=s==null?[0,0]:typeof s=="number"?[s,0]:s;let r=St(s),o=1-e[0],a=Ct(e[1],Vt),l=Ct(e[2],1),c=Ct(i.disp,el),h=Ct(i.each,f=>{}),{fill:u,stroke:d}=c;return(f,m,_,g)=>Lr(f,m,(p,y,A,S,P,E,x,T,k,D,N)=>{let z=p.pxRound,H=t,I=n*Pt,W=a*Pt,$=l*Pt,G,ce;S.ori==0?[G,ce]=r(f,m):[ce,G]=r(f,m);let J=S.dir*(S.ori==0?1:-1),Q=S.ori==0?Qh:gp,se=S.ori==0?h:(Re,Ze,at,Me,Bt,ze,Ye)=>{h(Re,Ze,at,Bt,Me,Ye,ze)},de=Ct(f.bands,cp).find(Re=>Re.series[0]==m),ue=de!=null?de.dir:0,ee=p.fillTo(f,m,p.min,p.max,ue),me=z(x(ee,P,N,k)),xe,Ae,Se,We=D,ot=z(p.width*Pt),Ve=!1,mt=null,ht=null,st=null,Jt=null;u!=null&&(ot==0||d!=null)&&(Ve=!0,mt=u.values(f,m,_,g),ht=new Map,new Set(mt).forEach(Re=>{Re!=null&&ht.set(Re,new Path2D)}),ot>0&&(st=d.values(f,m,_,g),Jt=new Map,new Set(st).forEach(Re=>{Re!=null&&Jt.set(Re,new Path2D)})));let{x0:Ht,size:un}=c;if(Ht!=null&&un!=null){H=1,y=Ht.values(f,m,_,g),Ht.unit==2&&(y=y.map(at=>f.posToVal(T+at*D,S.key,!0)));let Re=un.values(f,m,_,g);un.unit==2?Ae=Re[0]*D:Ae=E(Re[0],S,D,T)-E(0,S,D,T),We=wv(y,A,E,S,D,T,We),Se=We-Ae+I}else We=wv(y,A,E,S,D,T,We),Se=We*o+I,Ae=We-Se;Se<1&&(Se=0),ot>=Ae/2&&(ot=0),Se<5&&(z=Nv);let Ut=Se>0,En=We-Se-(Ut?ot:0);Ae=z(Jf(En,$,W)),xe=(H==0?Ae/2:H==J?0:Ae)-H*J*((H==0?I/2:0)+(Ut?ot/2:0));let wt={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},yn=Ve?null:new Path2D,nn=null;if(de!=null)nn=f.data[de.series[1]];else{let{y0:Re,y1:Ze}=c;Re!=null&&Ze!=null&&(A=Ze.values(f,m,_,g),nn=Re.values(f,m,_,g))}let dn=G*Ae,O=ce*Ae;for(let Re=J==1?_:g;Re>=_&&Re<=g;Re+=J){let Ze=A[Re];if(Ze==null)continue;if(nn!=null){let q=nn[Re]??0;if(Ze-q==0)continue;me=x(q,P,N,k)}let at=S.distr!=2||c!=null?y[Re]:Re,Me=E(at,S,D,T),Bt=x(Ct(Ze,ee),P,N,k),ze=z(Me-xe),Ye=z(Qn(Bt,me)),C=z(Xi(Bt,me)),b=Ye-C;if(Ze!=null){let q=Ze<0?O:dn,he=Ze<0?dn:O;Ve?(ot>0&&st[Re]!=null&&Q(Jt.get(st[Re]),ze,C+yi(ot/2),Ae,Qn(0,b-ot),q,he),mt[Re]!=null&&Q(ht.get(mt[Re]),ze,C+yi(ot/2),Ae,Qn(0,b-ot),q,he)):Q(yn,ze,C+yi(ot/2),Ae,Qn(0,b-ot),q,he),se(f,m,Re,ze-ot/2,C,Ae+ot,b)}}return ot>0?wt.stroke=Ve?Jt:yn:Ve||(wt._fill=p.width==0?p._fill:p._stroke??p._fill,wt.width=0),wt.fill=Ve?ht:yn,wt})}function cA(i,e){let t=Ct(e?.alignGaps,0);return(n,s,r,o)=>Lr(n,s,(a,l,c,h,u,d,f,m,_,g,p)=>{[r,o]=qh(c,r,o);let y=a.pxRound,A=G=>y(d(G,h,g,m)),S=G=>y(f(G,u,p,_)),P,E,x;h.ori==0?(P=Jh,x=Oo,E=ox):(P=jh,x=Uo,E=ax);let T=h.dir*(h.ori==0?1:-1),k=A(l[T==1?r:o]),D=k,N=[],z=[];for(let G=T==1?r:o;G>=r&&G<=o;G+=T)if(c[G]!=null){let J=l[G],Q=A(J);N.push(D=Q),z.push(S(c[G]))}let H={stroke:i(N,z,P,x,E,y),fill:null,clip:null,band:null,gaps:null,flags:Do},I=H.stroke,[W,$]=pp(n,s);if(a.fill!=null||W!=0){let G=H.fill=new Path2D(I),ce=a.fillTo(n,s,a.min,a.max,W),J=S(ce);x(G,D,J),x(G,k,J)}if(!a.spanGaps){let G=[];G.push(...mp(l,c,r,o,T,A,t)),H.gaps=G=a.gaps(n,s,r,o,G),H.clip=Kh(G,h.ori,m,_,g,p)}return $!=0&&(H.band=$==2?[Fs(n,s,r,o,I,-1),Fs(n,s,r,o,I,1)]:Fs(n,s,r,o,I,$)),H})}function hA(i){return cA(uA,i)}function uA(i,e,t,n,s,r){let o=i.length;if(o<2)return null;let a=new Path2D;if(t(a,i[0],e[0]),o==2)n(a,i[1],e[1]);else{let l=Array(o),c=Array(o-1),h=Array(o-1),u=Array(o-1);for(let d=0;d<o-1;d++)h[d]=e[d+1]-e[d],u[d]=i[d+1]-i[d],c[d]=h[d]/u[d];l[0]=c[0];for(let d=1;d<o-1;d++)c[d]===0||c[d-1]===0||c[d-1]>0!=c[d]>0?l[d]=0:(l[d]=3*(u[d-1]+u[d])/((2*u[d]+u[d-1])/c[d-1]+(u[d]+2*u[d-1])/c[d]),isFinite(l[d])||(l[d]=0));l[o-1]=c[o-2];for(let d=0;d<o-1;d++)s(a,i[d]+u[d]/3,e[d]+l[d]*u[d]/3,i[d+1]-u[d]/3,e[d+1]-l[d+1]*u[d]/3,i[d+1],e[d+1])}return a}var tp=new Set;function Tv(){for(let i of tp)i.syncRect(!0)}Fo&&(Rr(XT,Po,Tv),Rr(qT,Po,Tv,!0),Rr(Hh,Po,()=>{kn.pxRatio=Pt}));var dA=hx(),fA=lx();function Ev(i,e,t,n){return(n?[i[0],i[1]].concat(i.slice(2)):[i[0]].concat(i.slice(1))).map((r,o)=>np(r,o,e,t))}function pA(i,e){return i.map((t,n)=>n==0?{}:xn({},e,t))}function np(i,e,t,n){return xn({},e==0?t:n,i)}function ux(i,e,t){return e==null?Io:[e,t]}var mA=ux;function gA(i,e,t){return e==null?Io:Wh(e,t,ap,!0)}function dx(i,e,t,n){return e==null?Io:Yh(e,t,i.scales[n].log,!1)}var vA=dx;function fx(i,e,t,n){return e==null?Io:op(e,t,i.scales[n].log,!1)}var xA=fx;function yA(i,e,t,n,s){let r=Qn(sv(i),sv(e)),o=e-i,a=Wi(s/n*o,t);do{let l=t[a],c=n*l/o;if(c>=s&&r+(l<5?rr.get(l):0)<=17)return[l,c]}while(++a<t.length);return[0,0]}function Av(i){let e,t;return i=i.replace(/(\d+)px/,(n,s)=>(e=Mn((t=+s)*Pt))+"px"),[i,e,t]}function _A(i){i.show&&[i.font,i.labelFont].forEach(e=>{let t=Gt(e[2]*Pt,1);e[0]=e[0].replace(/[0-9.]+px/,t+"px"),e[1]=t})}function kn(i,e,t){let n={mode:Ct(i.mode,1)},s=n.mode;function r(v,M,R,L){let V=M.valToPct(v);return L+R*(M.dir==-1?1-V:V)}function o(v,M,R,L){let V=M.valToPct(v);return L+R*(M.dir==-1?V:1-V)}function a(v,M,R,L){return M.ori==0?r(v,M,R,L):o(v,M,R,L)}n.valToPosH=r,n.valToPosV=o;let l=!1;n.status=0;let c=n.root=Pi(AT);if(i.id!=null&&(c.id=i.id),xi(c,i.class),i.title){let v=Pi(PT,c);v.textContent=i.title}let h=Hi("canvas"),u=n.ctx=h.getContext("2d"),d=Pi(LT,c);Rr("click",d,v=>{v.target===m&&(Xt!=Br||jt!=zr)&&Nn.click(n,v)},!0);let f=n.under=Pi(IT,d);d.appendChild(h);let m=n.over=Pi(NT,d);i=No(i);let _=+Ct(i.pxAlign,1),g=Mv(_);(i.plugins||[]).forEach(v=>{v.opts&&(i=v.opts(n,i)||i)});let p=i.ms||.001,y=n.series=s==1?Ev(i.series||[],gv,bv,!1):pA(i.series||[null],_v),A=n.axes=Ev(i.axes||[],mv,xv,!0),S=n.scales={},P=n.bands=i.bands||[];P.forEach(v=>{v.fill=St(v.fill||null),v.dir=Ct(v.dir,-1)});let E=s==2?y[1].facets[0].scale:y[0].scale,x={axes:vs,series:xt},T=(i.drawOrder||["axes","series"]).map(v=>x[v]);function k(v){let M=v.distr==3?R=>Ds(R>0?R:v.clamp(n,R,v.min,v.max,v.key)):v.distr==4?R=>Hf(R,v.asinh):v.distr==100?R=>v.fwd(R):R=>R;return R=>{let L=M(R),{_min:V,_max:K}=v,ae=K-V;return(L-V)/ae}}function D(v){let M=S[v];if(M==null){let R=(i.scales||el)[v]||el;if(R.from!=null){D(R.from);let L=xn({},S[R.from],R,{key:v});L.valToPct=k(L),S[v]=L}else{M=S[v]=xn({},v==E?tx:nA,R),M.key=v;let L=M.time,V=M.range,K=sr(V);if((v!=E||s==2&&!L)&&(K&&(V[0]==null||V[1]==null)&&(V={min:V[0]==null?tv:{mode:1,hard:V[0],soft:V[0]},max:V[1]==null?tv:{mode:1,hard:V[1],soft:V[1]}},K=!1),!K&&Zh(V))){let ae=V;V=(fe,_e,Ne)=>_e==null?Io:Wh(_e,Ne,ae)}M.range=St(V||(L?mA:v==E?M.distr==3?vA:M.distr==4?xA:ux:M.distr==3?dx:M.distr==4?fx:gA)),M.auto=St(K?!1:M.auto),M.clamp=St(M.clamp||tA),M._min=M._max=null,M.valToPct=k(M)}}}D("x"),D("y"),s==1&&y.forEach(v=>{D(v.scale)}),A.forEach(v=>{D(v.scale)});for(let v in i.scales)D(v);let N=S[E],z=N.distr,H,I;N.ori==0?(xi(c,CT),H=r,I=o):(xi(c,RT),H=o,I=r);let W={};for(let v in S){let M=S[v];(M.min!=null||M.max!=null)&&(W[v]={min:M.min,max:M.max},M.min=M.max=null)}let $=i.tzDate||(v=>new Date(Mn(v/p))),G=i.fmtDate||hp,ce=p==1?CE($):LE($),J=dv($,uv(p==1?AE:PE,G)),Q=pv($,fv(NE,G)),se=[],de=n.legend=xn({},OE,i.legend),ue=n.cursor=xn({},GE,{drag:{y:s==2}},i.cursor),ee=de.show,me=ue.show,xe=de.markers;de.idxs=se,xe.width=St(xe.width),xe.dash=St(xe.dash),xe.stroke=St(xe.stroke),xe.fill=St(xe.fill);let Ae,Se,We,ot=[],Ve=[],mt,ht=!1,st={};if(de.live){let v=y[1]?y[1].values:null;ht=v!=null,mt=ht?v(n,1,0):{_:0};for(let M in mt)st[M]=sp}if(ee)if(Ae=Hi("table",BT,c),We=Hi("tbody",null,Ae),de.mount(n,Ae),ht){Se=Hi("thead",null,Ae,We);let v=Hi("tr",null,Se);Hi("th",null,v);for(var Jt in mt)Hi("th",G0,v).textContent=Jt}else xi(Ae,VT),de.live&&xi(Ae,zT);let Ht={show:!0},un={show:!1};function Ut(v,M){if(M==0&&(ht||!de.live||s==2))return Io;let R=[],L=Hi("tr",GT,We,We.childNodes[M]);xi(L,v.class),v.show||xi(L,Cr);let V=Hi("th",null,L);if(xe.show){let fe=Pi(HT,V);if(M>0){let _e=xe.width(n,M);_e&&(fe.style.border=_e+"px "+xe.dash(n,M)+" "+xe.stroke(n,M)),fe.style.background=xe.fill(n,M)}}let K=Pi(G0,V);v.label instanceof HTMLElement?K.appendChild(v.label):K.textContent=v.label,M>0&&(xe.show||(K.style.color=v.width>0?xe.stroke(n,M):xe.fill(n,M)),wt("click",V,fe=>{if(ue._lock)return;je(fe);let _e=y.indexOf(v);if((fe.ctrlKey||fe.metaKey)!=de.isolate){let Ne=y.some((De,Oe)=>Oe>0&&Oe!=_e&&De.show);y.forEach((De,Oe)=>{Oe>0&&Ki(Oe,Ne?Oe==_e?Ht:un:Ht,!0,gn.setSeries)})}else Ki(_e,{show:!v.show},!0,gn.setSeries)},!1),Qe&&wt(q0,V,fe=>{ue._lock||(je(fe),Ki(y.indexOf(v),Gr,!0,gn.setSeries))},!1));for(var ae in mt){let fe=Hi("td",WT,L);fe.textContent="--",R.push(fe)}return[L,R]}let En=new Map;function wt(v,M,R,L=!0){let V=En.get(M)||{},K=ue.bind[v](n,M,R,L);K&&(Rr(v,M,V[v]=K),En.set(M,V))}function yn(v,M,R){let L=En.get(M)||{};for(let V in L)(v==null||V==v)&&(Kf(V,M,L[V]),delete L[V]);v==null&&En.delete(M)}let nn=0,dn=0,O=0,Re=0,Ze=0,at=0,Me=Ze,Bt=at,ze=O,Ye=Re,C=0,b=0,q=0,he=0;n.bbox={};let oe=!1,ve=!1,ye=!1,te=!1,ie=!1,pe=!1;function F(v,M,R){(R||v!=n.width||M!=n.height)&&re(v,M),ut(!1),ye=!0,ve=!0,Bn()}function re(v,M){n.width=nn=O=v,n.height=dn=Re=M,Ze=at=0,be(),Ge();let R=n.bbox;C=R.left=Er(Ze*Pt,.5),b=R.top=Er(at*Pt,.5),q=R.width=Er(O*Pt,.5),he=R.height=Er(Re*Pt,.5)}let ne=3;function we(){let v=!1,M=0;for(;!v;){M++;let R=Or(M),L=Zi(M);v=M==ne||R&&L,v||(re(n.width,n.height),ve=!0)}}function ge({width:v,height:M}){F(v,M)}n.setSize=ge;function be(){let v=!1,M=!1,R=!1,L=!1;A.forEach((V,K)=>{if(V.show&&V._show){let{side:ae,_size:fe}=V,_e=ae%2,Ne=V.label!=null?V.labelSize:0,De=fe+Ne;De>0&&(_e?(O-=De,ae==3?(Ze+=De,L=!0):R=!0):(Re-=De,ae==0?(at+=De,v=!0):M=!0))}}),Yi[0]=v,Yi[1]=R,Yi[2]=M,Yi[3]=L,O-=Ii[1]+Ii[3],Ze+=Ii[3],Re-=Ii[2]+Ii[0],at+=Ii[0]}function Ge(){let v=Ze+O,M=at+Re,R=Ze,L=at;function V(K,ae){switch(K){case 1:return v+=ae,v-ae;case 2:return M+=ae,M-ae;case 3:return R-=ae,R+ae;case 0:return L-=ae,L+ae}}A.forEach((K,ae)=>{if(K.show&&K._show){let fe=K.side;K._pos=V(fe,K._size),K.label!=null&&(K._lpos=V(fe,K.labelSize))}})}if(ue.dataIdx==null){let v=ue.hover,M=v.skip=new Set(v.skip??[]);M.add(void 0);let R=v.prox=St(v.prox),L=v.bias??=0;ue.dataIdx=(V,K,ae,fe)=>{if(K==0)return ae;let _e=ae,Ne=R(V,K,ae,fe)??Vt,De=Ne>=0&&Ne<Vt,Oe=N.ori==0?O:Re,rt=ue.left,Rt=e[0],Et=e[K];if(M.has(Et[ae])){_e=null;let _t=null,Je=null,Xe;if(L==0||L==-1)for(Xe=ae;_t==null&&Xe-- >0;)M.has(Et[Xe])||(_t=Xe);if(L==0||L==1)for(Xe=ae;Je==null&&Xe++<Et.length;)M.has(Et[Xe])||(Je=Xe);if(_t!=null||Je!=null)if(De){let Yt=_t==null?-1/0:H(Rt[_t],N,Oe,0),on=Je==null?1/0:H(Rt[Je],N,Oe,0),Pn=rt-Yt,kt=on-rt;Pn<=kt?Pn<=Ne&&(_e=_t):kt<=Ne&&(_e=Je)}else _e=Je==null?_t:_t==null?Je:ae-_t<=Je-ae?_t:Je}else De&&wn(rt-H(Rt[ae],N,Oe,0))>Ne&&(_e=null);return _e}}let je=v=>{ue.event=v};ue.idxs=se,ue._lock=!1;let le=ue.points;le.show=St(le.show),le.size=St(le.size),le.stroke=St(le.stroke),le.width=St(le.width),le.fill=St(le.fill);let Ue=n.focus=xn({},i.focus||{alpha:.3},ue.focus),Qe=Ue.prox>=0,Ce=Qe&&le.one,lt=[],Wt=[],Hn=[];function Go(v,M){let R=le.show(n,M);if(R instanceof HTMLElement)return xi(R,kT),xi(R,v.class),ds(R,-10,-10,O,Re),m.insertBefore(R,lt[M]),R}function Nr(v,M){if(s==1||M>0){let R=s==1&&S[v.scale].time,L=v.value;v.value=R?av(L)?pv($,fv(L,G)):L||Q:L||jE,v.label=v.label||(R?WE:HE)}if(Ce||M>0){v.width=v.width==null?1:v.width,v.paths=v.paths||dA||nE,v.fillTo=St(v.fillTo||iA),v.pxAlign=+Ct(v.pxAlign,_),v.pxRound=Mv(v.pxAlign),v.stroke=St(v.stroke||null),v.fill=St(v.fill||null),v._stroke=v._fill=v._paths=v._focus=null;let R=QE(Qn(1,v.width),1),L=v.points=xn({},{size:R,width:Qn(1,R*.2),stroke:v.stroke,space:R*2,paths:fA,_stroke:null,_fill:null},v.points);L.show=St(L.show),L.filter=St(L.filter),L.fill=St(L.fill),L.stroke=St(L.stroke),L.paths=St(L.paths),L.pxAlign=v.pxAlign}if(ee){let R=Ut(v,M);ot.splice(M,0,R[0]),Ve.splice(M,0,R[1]),de.values.push(null)}if(me){se.splice(M,0,null);let R=null;Ce?M==0&&(R=Go(v,M)):M>0&&(R=Go(v,M)),lt.splice(M,0,R),Wt.splice(M,0,0),Hn.splice(M,0,0)}Rn("addSeries",M)}function Qu(v,M){M=M??y.length,v=s==1?np(v,M,gv,bv):np(v,M,{},_v),y.splice(M,0,v),Nr(y[M],M)}n.addSeries=Qu;function dl(v){if(y.splice(v,1),ee){de.values.splice(v,1),Ve.splice(v,1);let M=ot.splice(v,1)[0];yn(null,M.firstChild),M.remove()}me&&(se.splice(v,1),lt.splice(v,1)[0].remove(),Wt.splice(v,1),Hn.splice(v,1)),Rn("delSeries",v)}n.delSeries=dl;let Yi=[!1,!1,!1,!1];function ps(v,M){if(v._show=v.show,v.show){let R=v.side%2,L=S[v.scale];L==null&&(v.scale=R?y[1].scale:E,L=S[v.scale]);let V=L.time;v.size=St(v.size),v.space=St(v.space),v.rotate=St(v.rotate),sr(v.incrs)&&v.incrs.forEach(ae=>{!rr.has(ae)&&rr.set(ae,Ov(ae))}),v.incrs=St(v.incrs||(L.distr==2?wE:V?p==1?EE:RE:Ar)),v.splits=St(v.splits||(V&&L.distr==1?ce:L.distr==3?jf:L.distr==4?YE:qE)),v.stroke=St(v.stroke),v.grid.stroke=St(v.grid.stroke),v.ticks.stroke=St(v.ticks.stroke),v.border.stroke=St(v.border.stroke);let K=v.values;v.values=sr(K)&&!sr(K[0])?St(K):V?sr(K)?dv($,uv(K,G)):av(K)?IE($,K):K||J:K||XE,v.filter=St(v.filter||(L.distr>=3&&L.log==10?KE:L.distr==3&&L.log==2?JE:Dv)),v.font=Av(v.font),v.labelFont=Av(v.labelFont),v._size=v.size(n,null,M,0),v._space=v._rotate=v._incrs=v._found=v._splits=v._values=null,v._size>0&&(Yi[M]=!0,v._el=Pi(DT,d))}}function ms(v,M,R,L){let[V,K,ae,fe]=R,_e=M%2,Ne=0;return _e==0&&(fe||K)&&(Ne=M==0&&!V||M==2&&!ae?Mn(mv.size/3):0),_e==1&&(V||ae)&&(Ne=M==1&&!K||M==3&&!fe?Mn(xv.size/2):0),Ne}let Ho=n.padding=(i.padding||[ms,ms,ms,ms]).map(v=>St(Ct(v,ms))),Ii=n._padding=Ho.map((v,M)=>v(n,M,Yi,0)),sn,cn=null,hn=null,$i=s==1?y[0].idxs:null,oi=null,Os=!1;function Wo(v,M){if(e=v??[],n.data=n._data=e,s==2){sn=0;for(let R=1;R<y.length;R++)sn+=e[R][0].length}else{e.length==0&&(n.data=n._data=e=[[]]),oi=e[0],sn=oi.length;let R=e;if(z==2){R=e.slice();let L=R[0]=Array(sn);for(let V=0;V<sn;V++)L[V]=V}n._data=e=R}if(ut(!0),Rn("setData"),z==2&&(ye=!0),M!==!1){let R=N;R.auto(n,Os)?Xo():Bs(E,R.min,R.max),te=te||ue.left>=0,pe=!0,Bn()}}n.setData=Wo;function Xo(){Os=!0;let v,M;s==1&&(sn>0?(cn=$i[0]=0,hn=$i[1]=sn-1,v=e[0][cn],M=e[0][hn],z==2?(v=cn,M=hn):v==M&&(z==3?[v,M]=Yh(v,v,N.log,!1):z==4?[v,M]=op(v,v,N.log,!1):N.time?M=v+Mn(86400/p):[v,M]=Wh(v,M,ap,!0))):(cn=$i[0]=v=null,hn=$i[1]=M=null)),Bs(E,v,M)}let Dr,Us,Fr,w,B,j,Y,Z,Te,Pe;function Ee(v,M,R,L,V,K){v??=W0,R??=cp,L??="butt",V??=W0,K??="round",v!=Dr&&(u.strokeStyle=Dr=v),V!=Us&&(u.fillStyle=Us=V),M!=Fr&&(u.lineWidth=Fr=M),K!=B&&(u.lineJoin=B=K),L!=j&&(u.lineCap=j=L),R!=w&&u.setLineDash(w=R)}function Le(v,M,R,L){M!=Us&&(u.fillStyle=Us=M),v!=Y&&(u.font=Y=v),R!=Z&&(u.textAlign=Z=R),L!=Te&&(u.textBaseline=Te=L)}function Be(v,M,R,L,V=0){if(L.length>0&&v.auto(n,Os)&&(M==null||M.min==null)){let K=Ct(cn,0),ae=Ct(hn,L.length-1),fe=R.min==null?KT(L,K,ae,V,v.distr==3):[R.min,R.max];v.min=Xi(v.min,R.min=fe[0]),v.max=Qn(v.max,R.max=fe[1])}}let tt={min:null,max:null};function vt(){for(let L in S){let V=S[L];W[L]==null&&(V.min==null||W[E]!=null&&V.auto(n,Os))&&(W[L]=tt)}for(let L in S){let V=S[L];W[L]==null&&V.from!=null&&W[V.from]!=null&&(W[L]=tt)}W[E]!=null&&ut(!0);let v={};for(let L in W){let V=W[L];if(V!=null){let K=v[L]=No(S[L],rE);if(V.min!=null)xn(K,V);else if(L!=E||s==2)if(sn==0&&K.from==null){let ae=K.range(n,null,null,L);K.min=ae[0],K.max=ae[1]}else K.min=Vt,K.max=-Vt}}if(sn>0){y.forEach((L,V)=>{if(s==1){let K=L.scale,ae=W[K];if(ae==null)return;let fe=v[K];if(V==0){let _e=fe.range(n,fe.min,fe.max,K);fe.min=_e[0],fe.max=_e[1],cn=Wi(fe.min,e[0]),hn=Wi(fe.max,e[0]),hn-cn>1&&(e[0][cn]<fe.min&&cn++,e[0][hn]>fe.max&&hn--),L.min=oi[cn],L.max=oi[hn]}else L.show&&L.auto&&Be(fe,ae,L,e[V],L.sorted);L.idxs[0]=cn,L.idxs[1]=hn}else if(V>0&&L.show&&L.auto){let[K,ae]=L.facets,fe=K.scale,_e=ae.scale,[Ne,De]=e[V],Oe=v[fe],rt=v[_e];Oe!=null&&Be(Oe,W[fe],K,Ne,K.sorted),rt!=null&&Be(rt,W[_e],ae,De,ae.sorted),L.min=ae.min,L.max=ae.max}});for(let L in v){let V=v[L],K=W[L];if(V.from==null&&(K==null||K.min==null)){let ae=V.range(n,V.min==Vt?null:V.min,V.max==-Vt?null:V.max,L);V.min=ae[0],V.max=ae[1]}}}for(let L in v){let V=v[L];if(V.from!=null){let K=v[V.from];if(K.min==null)V.min=V.max=null;else{let ae=V.range(n,K.min,K.max,L);V.min=ae[0],V.max=ae[1]}}}let M={},R=!1;for(let L in v){let V=v[L],K=S[L];if(K.min!=V.min||K.max!=V.max){K.min=V.min,K.max=V.max;let ae=K.distr;K._min=ae==3?Ds(K.min):ae==4?Hf(K.min,K.asinh):ae==100?K.fwd(K.min):K.min,K._max=ae==3?Ds(K.max):ae==4?Hf(K.max,K.asinh):ae==100?K.fwd(K.max):K.max,M[L]=R=!0}}if(R){y.forEach((L,V)=>{s==2?V>0&&M.y&&(L._paths=null):M[L.scale]&&(L._paths=null)});for(let L in M)ye=!0,Rn("setScale",L);me&&ue.left>=0&&(te=pe=!0)}for(let L in W)W[L]=null}function ke(v){let M=Jf(cn-1,0,sn-1),R=Jf(hn+1,0,sn-1);for(;v[M]==null&&M>0;)M--;for(;v[R]==null&&R<sn-1;)R++;return[M,R]}function xt(){if(sn>0){let v=y.some(M=>M._focus)&&Pe!=Ue.alpha;v&&(u.globalAlpha=Pe=Ue.alpha),y.forEach((M,R)=>{if(R>0&&M.show&&(tn(R,!1),tn(R,!0),M._paths==null)){let L=Pe;Pe!=M.alpha&&(u.globalAlpha=Pe=M.alpha);let V=s==2?[0,e[R][0].length-1]:ke(e[R]);M._paths=M.paths(n,R,V[0],V[1]),Pe!=L&&(u.globalAlpha=Pe=L)}}),y.forEach((M,R)=>{if(R>0&&M.show){let L=Pe;Pe!=M.alpha&&(u.globalAlpha=Pe=M.alpha),M._paths!=null&&Dt(R,!1);{let V=M._paths!=null?M._paths.gaps:null,K=M.points.show(n,R,cn,hn,V),ae=M.points.filter(n,R,K,V);(K||ae)&&(M.points._paths=M.points.paths(n,R,cn,hn,ae),Dt(R,!0))}Pe!=L&&(u.globalAlpha=Pe=L),Rn("drawSeries",R)}}),v&&(u.globalAlpha=Pe=1)}}function tn(v,M){let R=M?y[v].points:y[v];R._stroke=R.stroke(n,v),R._fill=R.fill(n,v)}function Dt(v,M){let R=M?y[v].points:y[v],{stroke:L,fill:V,clip:K,flags:ae,_stroke:fe=R._stroke,_fill:_e=R._fill,_width:Ne=R.width}=R._paths;Ne=Gt(Ne*Pt,3);let De=null,Oe=Ne%2/2;M&&_e==null&&(_e=Ne>0?"#fff":fe);let rt=R.pxAlign==1&&Oe>0;if(rt&&u.translate(Oe,Oe),!M){let Rt=C-Ne/2,Et=b-Ne/2,_t=q+Ne,Je=he+Ne;De=new Path2D,De.rect(Rt,Et,_t,Je)}M?Fe(fe,Ne,R.dash,R.cap,_e,L,V,ae,K):Ft(v,fe,Ne,R.dash,R.cap,_e,L,V,ae,De,K),rt&&u.translate(-Oe,-Oe)}function Ft(v,M,R,L,V,K,ae,fe,_e,Ne,De){let Oe=!1;_e!=0&&P.forEach((rt,Rt)=>{if(rt.series[0]==v){let Et=y[rt.series[1]],_t=e[rt.series[1]],Je=(Et._paths||el).band;sr(Je)&&(Je=rt.dir==1?Je[0]:Je[1]);let Xe,Yt=null;Et.show&&Je&&jT(_t,cn,hn)?(Yt=rt.fill(n,Rt)||K,Xe=Et._paths.clip):Je=null,Fe(M,R,L,V,Yt,ae,fe,_e,Ne,De,Xe,Je),Oe=!0}}),Oe||Fe(M,R,L,V,K,ae,fe,_e,Ne,De)}let _n=Do|ep;function Fe(v,M,R,L,V,K,ae,fe,_e,Ne,De,Oe){Ee(v,M,R,L,V),(_e||Ne||Oe)&&(u.save(),_e&&u.clip(_e),Ne&&u.clip(Ne)),Oe?(fe&_n)==_n?(u.clip(Oe),De&&u.clip(De),bt(V,ae),fn(v,K,M)):fe&ep?(bt(V,ae),u.clip(Oe),fn(v,K,M)):fe&Do&&(u.save(),u.clip(Oe),De&&u.clip(De),bt(V,ae),u.restore(),fn(v,K,M)):(bt(V,ae),fn(v,K,M)),(_e||Ne||Oe)&&u.restore()}function fn(v,M,R){R>0&&(M instanceof Map?M.forEach((L,V)=>{u.strokeStyle=Dr=V,u.stroke(L)}):M!=null&&v&&u.stroke(M))}function bt(v,M){M instanceof Map?M.forEach((R,L)=>{u.fillStyle=Us=L,u.fill(R)}):M!=null&&v&&u.fill(M)}function gs(v,M,R,L){let V=A[v],K;if(L<=0)K=[0,0];else{let ae=V._space=V.space(n,v,M,R,L),fe=V._incrs=V.incrs(n,v,M,R,L,ae);K=yA(M,R,fe,L,ae)}return V._found=K}function pn(v,M,R,L,V,K,ae,fe,_e,Ne){let De=ae%2/2;_==1&&u.translate(De,De),Ee(fe,ae,_e,Ne,fe),u.beginPath();let Oe,rt,Rt,Et,_t=V+(L==0||L==3?-K:K);R==0?(rt=V,Et=_t):(Oe=V,Rt=_t);for(let Je=0;Je<v.length;Je++)M[Je]!=null&&(R==0?Oe=Rt=v[Je]:rt=Et=v[Je],u.moveTo(Oe,rt),u.lineTo(Rt,Et));u.stroke(),_==1&&u.translate(-De,-De)}function Or(v){let M=!0;return A.forEach((R,L)=>{if(!R.show)return;let V=S[R.scale];if(V.min==null){R._show&&(M=!1,R._show=!1,ut(!1));return}else R._show||(M=!1,R._show=!0,ut(!1));let K=R.side,ae=K%2,{min:fe,max:_e}=V,[Ne,De]=gs(L,fe,_e,ae==0?O:Re);if(De==0)return;let Oe=V.distr==2,rt=R._splits=R.splits(n,L,fe,_e,Ne,De,Oe),Rt=V.distr==2?rt.map(Xe=>oi[Xe]):rt,Et=V.distr==2?oi[rt[1]]-oi[rt[0]]:Ne,_t=R._values=R.values(n,R.filter(n,Rt,L,De,Et),L,De,Et);R._rotate=K==2?R.rotate(n,_t,L,De):0;let Je=R._size;R._size=Li(R.size(n,_t,L,v)),Je!=null&&R._size!=Je&&(M=!1)}),M}function Zi(v){let M=!0;return Ho.forEach((R,L)=>{let V=R(n,L,Yi,v);V!=Ii[L]&&(M=!1),Ii[L]=V}),M}function vs(){for(let v=0;v<A.length;v++){let M=A[v];if(!M.show||!M._show)continue;let R=M.side,L=R%2,V,K,ae=M.stroke(n,v),fe=R==0||R==3?-1:1,[_e,Ne]=M._found;if(M.label!=null){let qn=M.labelGap*fe,ci=Mn((M._lpos+qn)*Pt);Le(M.labelFont[0],ae,"center",R==2?"top":H0),u.save(),L==1?(V=K=0,u.translate(ci,Mn(b+he/2)),u.rotate((R==3?-Gh:Gh)/2)):(V=Mn(C+q/2),K=ci);let hr=Iv(M.label)?M.label(n,v,_e,Ne):M.label;u.fillText(hr,V,K),u.restore()}if(Ne==0)continue;let De=S[M.scale],Oe=L==0?q:he,rt=L==0?C:b,Rt=M._splits,Et=De.distr==2?Rt.map(qn=>oi[qn]):Rt,_t=De.distr==2?oi[Rt[1]]-oi[Rt[0]]:_e,Je=M.ticks,Xe=M.border,Yt=Je.show?Je.size:0,on=Mn(Yt*Pt),Pn=Mn((M.alignTo==2?M._size-Yt-M.gap:M.gap)*Pt),kt=M._rotate*-Gh/180,an=g(M._pos*Pt),ai=(on+Pn)*fe,Xn=an+ai;K=L==0?Xn:0,V=L==1?Xn:0;let Si=M.font[0],Ni=M.align==1?Co:M.align==2?zf:kt>0?Co:kt<0?zf:L==0?"center":R==3?zf:Co,ji=kt||L==1?"middle":R==2?"top":H0;Le(Si,ae,Ni,ji);let li=M.font[1]*M.lineGap,Mi=Rt.map(qn=>g(a(qn,De,Oe,rt))),Di=M._values;for(let qn=0;qn<Di.length;qn++){let ci=Di[qn];if(ci!=null){L==0?V=Mi[qn]:K=Mi[qn],ci=""+ci;let hr=ci.indexOf(`
`)==-1?[ci]:ci.split(/\n/gm);for(let Yn=0;Yn<hr.length;Yn++){let am=hr[Yn];kt?(u.save(),u.translate(V,K+Yn*li),u.rotate(kt),u.fillText(am,0,0),u.restore()):u.fillText(am,V,K+Yn*li)}}}Je.show&&pn(Mi,Je.filter(n,Et,v,Ne,_t),L,R,an,on,Gt(Je.width*Pt,3),Je.stroke(n,v),Je.dash,Je.cap);let Qi=M.grid;Qi.show&&pn(Mi,Qi.filter(n,Et,v,Ne,_t),L,L==0?2:1,L==0?b:C,L==0?he:q,Gt(Qi.width*Pt,3),Qi.stroke(n,v),Qi.dash,Qi.cap),Xe.show&&pn([an],[1],L==0?1:0,L==0?1:2,L==1?b:C,L==1?he:q,Gt(Xe.width*Pt,3),Xe.stroke(n,v),Xe.dash,Xe.cap)}Rn("drawAxes")}function ut(v){y.forEach((M,R)=>{R>0&&(M._paths=null,v&&(s==1?(M.min=null,M.max=null):M.facets.forEach(L=>{L.min=null,L.max=null})))})}let rn=!1,Wn=!1,Ot=[];function mn(){Wn=!1;for(let v=0;v<Ot.length;v++)Rn(...Ot[v]);Ot.length=0}function Bn(){rn||(dE(Hp),rn=!0)}function fl(v,M=!1){rn=!0,Wn=M,v(n),Hp(),M&&Ot.length>0&&queueMicrotask(mn)}n.batch=fl;function Hp(){if(oe&&(vt(),oe=!1),ye&&(we(),ye=!1),ve){if(Kt(f,Co,Ze),Kt(f,"top",at),Kt(f,Ka,O),Kt(f,Ja,Re),Kt(m,Co,Ze),Kt(m,"top",at),Kt(m,Ka,O),Kt(m,Ja,Re),Kt(d,Ka,nn),Kt(d,Ja,dn),h.width=Mn(nn*Pt),h.height=Mn(dn*Pt),A.forEach(({_el:v,_show:M,_size:R,_pos:L,side:V})=>{if(v!=null)if(M){let K=V===3||V===0?R:0,ae=V%2==1;Kt(v,ae?"left":"top",L-K),Kt(v,ae?"width":"height",R),Kt(v,ae?"top":"left",ae?at:Ze),Kt(v,ae?"height":"width",ae?Re:O),Zf(v,Cr)}else xi(v,Cr)}),Dr=Us=Fr=B=j=Y=Z=Te=w=null,Pe=1,$o(!0),Ze!=Me||at!=Bt||O!=ze||Re!=Ye){ut(!1);let v=O/ze,M=Re/Ye;if(me&&!te&&ue.left>=0){ue.left*=v,ue.top*=M,Ur&&ds(Ur,Mn(ue.left),0,O,Re),kr&&ds(kr,0,Mn(ue.top),O,Re);for(let R=0;R<lt.length;R++){let L=lt[R];L!=null&&(Wt[R]*=v,Hn[R]*=M,ds(L,Li(Wt[R]),Li(Hn[R]),O,Re))}}if(qt.show&&!ie&&qt.left>=0&&qt.width>0){qt.left*=v,qt.width*=v,qt.top*=M,qt.height*=M;for(let R in rd)Kt(Vr,R,qt[R])}Me=Ze,Bt=at,ze=O,Ye=Re}Rn("setSize"),ve=!1}nn>0&&dn>0&&(u.clearRect(0,0,h.width,h.height),Rn("drawClear"),T.forEach(v=>v()),Rn("draw")),qt.show&&ie&&(pl(qt),ie=!1),me&&te&&(cr(null,!0,!1),te=!1),de.show&&de.live&&pe&&(id(),pe=!1),l||(l=!0,n.status=1,Rn("ready")),Os=!1,rn=!1}n.redraw=(v,M)=>{ye=M||!1,v!==!1?Bs(E,N.min,N.max):Bn()};function ed(v,M){let R=S[v];if(R.from==null){if(sn==0){let L=R.range(n,M.min,M.max,v);M.min=L[0],M.max=L[1]}if(M.min>M.max){let L=M.min;M.min=M.max,M.max=L}if(sn>1&&M.min!=null&&M.max!=null&&M.max-M.min<1e-16)return;v==E&&R.distr==2&&sn>0&&(M.min=Wi(M.min,e[0]),M.max=Wi(M.max,e[0]),M.min==M.max&&M.max++),W[v]=M,oe=!0,Bn()}}n.setScale=ed;let td,nd,Ur,kr,Wp,Xp,Br,zr,qp,Yp,Xt,jt,ks=!1,Nn=ue.drag,An=Nn.x,Cn=Nn.y;me&&(ue.x&&(td=Pi(OT,m)),ue.y&&(nd=Pi(UT,m)),N.ori==0?(Ur=td,kr=nd):(Ur=nd,kr=td),Xt=ue.left,jt=ue.top);let qt=n.select=xn({show:!0,over:!0,left:0,width:0,top:0,height:0},i.select),Vr=qt.show?Pi(FT,qt.over?m:f):null;function pl(v,M){if(qt.show){for(let R in v)qt[R]=v[R],R in rd&&Kt(Vr,R,v[R]);M!==!1&&Rn("setSelect")}}n.setSelect=pl;function by(v){if(y[v].show)ee&&Zf(ot[v],Cr);else if(ee&&xi(ot[v],Cr),me){let R=Ce?lt[0]:lt[v];R!=null&&ds(R,-10,-10,O,Re)}}function Bs(v,M,R){ed(v,{min:M,max:R})}function Ki(v,M,R,L){M.focus!=null&&Ey(v),M.show!=null&&y.forEach((V,K)=>{K>0&&(v==K||v==null)&&(V.show=M.show,by(K),s==2?(Bs(V.facets[0].scale,null,null),Bs(V.facets[1].scale,null,null)):Bs(V.scale,null,null),Bn())}),R!==!1&&Rn("setSeries",v,M),L&&Zo("setSeries",n,v,M)}n.setSeries=Ki;function Sy(v,M){xn(P[v],M)}function My(v,M){v.fill=St(v.fill||null),v.dir=Ct(v.dir,-1),M=M??P.length,P.splice(M,0,v)}function wy(v){v==null?P.length=0:P.splice(v,1)}n.addBand=My,n.setBand=Sy,n.delBand=wy;function Ty(v,M){y[v].alpha=M,me&&lt[v]!=null&&(lt[v].style.opacity=M),ee&&ot[v]&&(ot[v].style.opacity=M)}let xs,zs,lr,Gr={focus:!0};function Ey(v){if(v!=lr){let M=v==null,R=Ue.alpha!=1;y.forEach((L,V)=>{if(s==1||V>0){let K=M||V==0||V==v;L._focus=M?null:K,R&&Ty(V,K?1:Ue.alpha)}}),lr=v,R&&Bn()}}ee&&Qe&&wt(Y0,Ae,v=>{ue._lock||(je(v),lr!=null&&Ki(null,Gr,!0,gn.setSeries))});function Ji(v,M,R){let L=S[M];R&&(v=v/Pt-(L.ori==1?at:Ze));let V=O;L.ori==1&&(V=Re,v=V-v),L.dir==-1&&(v=V-v);let K=L._min,ae=L._max,fe=v/V,_e=K+(ae-K)*fe,Ne=L.distr;return Ne==3?Lo(10,_e):Ne==4?eE(_e,L.asinh):Ne==100?L.bwd(_e):_e}function Ay(v,M){let R=Ji(v,E,M);return Wi(R,e[0],cn,hn)}n.valToIdx=v=>Wi(v,e[0]),n.posToIdx=Ay,n.posToVal=Ji,n.valToPos=(v,M,R)=>S[M].ori==0?r(v,S[M],R?q:O,R?C:0):o(v,S[M],R?he:Re,R?b:0),n.setCursor=(v,M,R)=>{Xt=v.left,jt=v.top,cr(null,M,R)};function $p(v,M){Kt(Vr,Co,qt.left=v),Kt(Vr,Ka,qt.width=M)}function Zp(v,M){Kt(Vr,"top",qt.top=v),Kt(Vr,Ja,qt.height=M)}let qo=N.ori==0?$p:Zp,Yo=N.ori==1?$p:Zp;function Cy(){if(ee&&de.live)for(let v=s==2?1:0;v<y.length;v++){if(v==0&&ht)continue;let M=de.values[v],R=0;for(let L in M)Ve[v][R++].firstChild.nodeValue=M[L]}}function id(v,M){if(v!=null&&(v.idxs?v.idxs.forEach((R,L)=>{se[L]=R}):sE(v.idx)||se.fill(v.idx),de.idx=se[0]),ee&&de.live){for(let R=0;R<y.length;R++)(R>0||s==1&&!ht)&&Ry(R,se[R]);Cy()}pe=!1,M!==!1&&Rn("setLegend")}n.setLegend=id;function Ry(v,M){let R=y[v],L=v==0&&z==2?oi:e[v],V;ht?V=R.values(n,v,M)??st:(V=R.value(n,M==null?null:L[M],v,M),V=V==null?st:{_:V}),de.values[v]=V}function cr(v,M,R){qp=Xt,Yp=jt,[Xt,jt]=ue.move(n,Xt,jt),ue.left=Xt,ue.top=jt,me&&(Ur&&ds(Ur,Mn(Xt),0,O,Re),kr&&ds(kr,0,Mn(jt),O,Re));let L,V=cn>hn;xs=Vt,zs=null;let K=N.ori==0?O:Re,ae=N.ori==1?O:Re;if(Xt<0||sn==0||V){L=ue.idx=null;for(let fe=0;fe<y.length;fe++){let _e=lt[fe];_e!=null&&ds(_e,-10,-10,O,Re)}Qe&&Ki(null,Gr,!0,v==null&&gn.setSeries),de.live&&(se.fill(L),pe=!0)}else{let fe,_e,Ne;s==1&&(fe=N.ori==0?Xt:jt,_e=Ji(fe,E),L=ue.idx=Wi(_e,e[0],cn,hn),Ne=H(e[0][L],N,K,0));let De=-10,Oe=-10,rt=0,Rt=0,Et=!0,_t="",Je="";for(let Xe=s==2?1:0;Xe<y.length;Xe++){let Yt=y[Xe],on=se[Xe],Pn=on==null?null:s==1?e[Xe][on]:e[Xe][1][on],kt=ue.dataIdx(n,Xe,L,_e),an=kt==null?null:s==1?e[Xe][kt]:e[Xe][1][kt];if(pe=pe||an!=Pn||kt!=on,se[Xe]=kt,Xe>0&&Yt.show){let ai=kt==null?-10:kt==L?Ne:H(s==1?e[0][kt]:e[Xe][0][kt],N,K,0),Xn=an==null?-10:I(an,s==1?S[Yt.scale]:S[Yt.facets[1].scale],ae,0);if(Qe&&an!=null){let Si=N.ori==1?Xt:jt,Ni=wn(Ue.dist(n,Xe,kt,Xn,Si));if(Ni<xs){let ji=Ue.bias;if(ji!=0){let li=Ji(Si,Yt.scale),Mi=an>=0?1:-1,Di=li>=0?1:-1;Di==Mi&&(Di==1?ji==1?an>=li:an<=li:ji==1?an<=li:an>=li)&&(xs=Ni,zs=Xe)}else xs=Ni,zs=Xe}}if(pe||Ce){let Si,Ni;N.ori==0?(Si=ai,Ni=Xn):(Si=Xn,Ni=ai);let ji,li,Mi,Di,Qi,qn,ci=!0,hr=le.bbox;if(hr!=null){ci=!1;let Yn=hr(n,Xe);Mi=Yn.left,Di=Yn.top,ji=Yn.width,li=Yn.height}else Mi=Si,Di=Ni,ji=li=le.size(n,Xe);if(qn=le.fill(n,Xe),Qi=le.stroke(n,Xe),Ce)Xe==zs&&xs<=Ue.prox&&(De=Mi,Oe=Di,rt=ji,Rt=li,Et=ci,_t=qn,Je=Qi);else{let Yn=lt[Xe];Yn!=null&&(Wt[Xe]=Mi,Hn[Xe]=Di,ev(Yn,ji,li,ci),j0(Yn,qn,Qi),ds(Yn,Li(Mi),Li(Di),O,Re))}}}}if(Ce){let Xe=Ue.prox,Yt=lr==null?xs<=Xe:xs>Xe||zs!=lr;if(pe||Yt){let on=lt[0];on!=null&&(Wt[0]=De,Hn[0]=Oe,ev(on,rt,Rt,Et),j0(on,_t,Je),ds(on,Li(De),Li(Oe),O,Re))}}}if(qt.show&&ks)if(v!=null){let[fe,_e]=gn.scales,[Ne,De]=gn.match,[Oe,rt]=v.cursor.sync.scales,Rt=v.cursor.drag;if(An=Rt._x,Cn=Rt._y,An||Cn){let{left:Et,top:_t,width:Je,height:Xe}=v.select,Yt=v.scales[Oe].ori,on=v.posToVal,Pn,kt,an,ai,Xn,Si=fe!=null&&Ne(fe,Oe),Ni=_e!=null&&De(_e,rt);Si&&An?(Yt==0?(Pn=Et,kt=Je):(Pn=_t,kt=Xe),an=S[fe],ai=H(on(Pn,Oe),an,K,0),Xn=H(on(Pn+kt,Oe),an,K,0),qo(Xi(ai,Xn),wn(Xn-ai))):qo(0,K),Ni&&Cn?(Yt==1?(Pn=Et,kt=Je):(Pn=_t,kt=Xe),an=S[_e],ai=I(on(Pn,rt),an,ae,0),Xn=I(on(Pn+kt,rt),an,ae,0),Yo(Xi(ai,Xn),wn(Xn-ai))):Yo(0,ae)}else od()}else{let fe=wn(qp-Wp),_e=wn(Yp-Xp);if(N.ori==1){let rt=fe;fe=_e,_e=rt}An=Nn.x&&fe>=Nn.dist,Cn=Nn.y&&_e>=Nn.dist;let Ne=Nn.uni;Ne!=null?An&&Cn&&(An=fe>=Ne,Cn=_e>=Ne,!An&&!Cn&&(_e>fe?Cn=!0:An=!0)):Nn.x&&Nn.y&&(An||Cn)&&(An=Cn=!0);let De,Oe;An&&(N.ori==0?(De=Br,Oe=Xt):(De=zr,Oe=jt),qo(Xi(De,Oe),wn(Oe-De)),Cn||Yo(0,ae)),Cn&&(N.ori==1?(De=Br,Oe=Xt):(De=zr,Oe=jt),Yo(Xi(De,Oe),wn(Oe-De)),An||qo(0,K)),!An&&!Cn&&(qo(0,0),Yo(0,0))}if(Nn._x=An,Nn._y=Cn,v==null){if(R){if(om!=null){let[fe,_e]=gn.scales;gn.values[0]=fe!=null?Ji(N.ori==0?Xt:jt,fe):null,gn.values[1]=_e!=null?Ji(N.ori==1?Xt:jt,_e):null}Zo(Vf,n,Xt,jt,O,Re,L)}if(Qe){let fe=R&&gn.setSeries,_e=Ue.prox;lr==null?xs<=_e&&Ki(zs,Gr,!0,fe):xs>_e?Ki(null,Gr,!0,fe):zs!=lr&&Ki(zs,Gr,!0,fe)}}pe&&(de.idx=L,id()),M!==!1&&Rn("setCursor")}let Vs=null;Object.defineProperty(n,"rect",{get(){return Vs==null&&$o(!1),Vs}});function $o(v=!1){v?Vs=null:(Vs=m.getBoundingClientRect(),Rn("syncRect",Vs))}function Kp(v,M,R,L,V,K,ae){ue._lock||ks&&v!=null&&v.movementX==0&&v.movementY==0||(sd(v,M,R,L,V,K,ae,!1,v!=null),v!=null?cr(null,!0,!0):cr(M,!0,!1))}function sd(v,M,R,L,V,K,ae,fe,_e){if(Vs==null&&$o(!1),je(v),v!=null)R=v.clientX-Vs.left,L=v.clientY-Vs.top;else{if(R<0||L<0){Xt=-10,jt=-10;return}let[Ne,De]=gn.scales,Oe=M.cursor.sync,[rt,Rt]=Oe.values,[Et,_t]=Oe.scales,[Je,Xe]=gn.match,Yt=M.axes[0].side%2==1,on=N.ori==0?O:Re,Pn=N.ori==1?O:Re,kt=Yt?K:V,an=Yt?V:K,ai=Yt?L:R,Xn=Yt?R:L;if(Et!=null?R=Je(Ne,Et)?a(rt,S[Ne],on,0):-10:R=on*(ai/kt),_t!=null?L=Xe(De,_t)?a(Rt,S[De],Pn,0):-10:L=Pn*(Xn/an),N.ori==1){let Si=R;R=L,L=Si}}_e&&(M==null||M.cursor.event.type==Vf)&&((R<=1||R>=O-1)&&(R=Er(R,O)),(L<=1||L>=Re-1)&&(L=Er(L,Re))),fe?(Wp=R,Xp=L,[Br,zr]=ue.move(n,R,L)):(Xt=R,jt=L)}let rd={width:0,height:0,left:0,top:0};function od(){pl(rd,!1)}let Jp,jp,Qp,em;function tm(v,M,R,L,V,K,ae){ks=!0,An=Cn=Nn._x=Nn._y=!1,sd(v,M,R,L,V,K,ae,!0,!1),v!=null&&(wt(Gf,Yf,nm,!1),Zo(X0,n,Br,zr,O,Re,null));let{left:fe,top:_e,width:Ne,height:De}=qt;Jp=fe,jp=_e,Qp=Ne,em=De}function nm(v,M,R,L,V,K,ae){ks=Nn._x=Nn._y=!1,sd(v,M,R,L,V,K,ae,!1,!0);let{left:fe,top:_e,width:Ne,height:De}=qt,Oe=Ne>0||De>0,rt=Jp!=fe||jp!=_e||Qp!=Ne||em!=De;if(Oe&&rt&&pl(qt),Nn.setScale&&Oe&&rt){let Rt=fe,Et=Ne,_t=_e,Je=De;if(N.ori==1&&(Rt=_e,Et=De,_t=fe,Je=Ne),An&&Bs(E,Ji(Rt,E),Ji(Rt+Et,E)),Cn)for(let Xe in S){let Yt=S[Xe];Xe!=E&&Yt.from==null&&Yt.min!=Vt&&Bs(Xe,Ji(_t+Je,Xe),Ji(_t,Xe))}od()}else ue.lock&&(ue._lock=!ue._lock,cr(M,!0,v!=null));v!=null&&(yn(Gf,Yf),Zo(Gf,n,Xt,jt,O,Re,null))}function Py(v,M,R,L,V,K,ae){if(ue._lock)return;je(v);let fe=ks;if(ks){let _e=!0,Ne=!0,De=10,Oe,rt;N.ori==0?(Oe=An,rt=Cn):(Oe=Cn,rt=An),Oe&&rt&&(_e=Xt<=De||Xt>=O-De,Ne=jt<=De||jt>=Re-De),Oe&&_e&&(Xt=Xt<Br?0:O),rt&&Ne&&(jt=jt<zr?0:Re),cr(null,!0,!0),ks=!1}Xt=-10,jt=-10,se.fill(null),cr(null,!0,!0),fe&&(ks=fe)}function im(v,M,R,L,V,K,ae){ue._lock||(je(v),Xo(),od(),v!=null&&Zo($0,n,Xt,jt,O,Re,null))}function sm(){A.forEach(_A),F(n.width,n.height,!0)}Rr(Hh,Po,sm);let Hr={};Hr.mousedown=tm,Hr.mousemove=Kp,Hr.mouseup=nm,Hr.dblclick=im,Hr.setSeries=(v,M,R,L)=>{let V=gn.match[2];R=V(n,M,R),R!=-1&&Ki(R,L,!0,!1)},me&&(wt(X0,m,tm),wt(Vf,m,Kp),wt(q0,m,v=>{je(v),$o(!1)}),wt(Y0,m,Py),wt($0,m,im),tp.add(n),n.syncRect=$o);let ml=n.hooks=i.hooks||{};function Rn(v,M,R){Wn?Ot.push([v,M,R]):v in ml&&ml[v].forEach(L=>{L.call(null,n,M,R)})}(i.plugins||[]).forEach(v=>{for(let M in v.hooks)ml[M]=(ml[M]||[]).concat(v.hooks[M])});let rm=(v,M,R)=>R,gn=xn({key:null,setSeries:!1,filters:{pub:rv,sub:rv},scales:[E,y[1]?y[1].scale:null],match:[ov,ov,rm],values:[null,null]},ue.sync);gn.match.length==2&&gn.match.push(rm),ue.sync=gn;let om=gn.key,ad=nx(om);function Zo(v,M,R,L,V,K,ae){gn.filters.pub(v,M,R,L,V,K,ae)&&ad.pub(v,M,R,L,V,K,ae)}ad.sub(n);function Ly(v,M,R,L,V,K,ae){gn.filters.sub(v,M,R,L,V,K,ae)&&Hr[v](null,M,R,L,V,K,ae)}n.pub=Ly;function Iy(){ad.unsub(n),tp.delete(n),En.clear(),Kf(Hh,Po,sm),c.remove(),Ae?.remove(),Rn("destroy")}n.destroy=Iy;function ld(){Rn("init",i,e),Wo(e||i.data,!1),W[E]?ed(E,W[E]):Xo(),ie=qt.show&&(qt.width>0||qt.height>0),te=pe=!0,F(i.width,i.height)}return y.forEach(Nr),A.forEach(ps),t?t instanceof HTMLElement?(t.appendChild(c),ld()):t(n,ld):ld(),n}kn.assign=xn;kn.fmtNum=lp;kn.rangeNum=Wh;kn.rangeLog=Yh;kn.rangeAsinh=op;kn.orient=Lr;kn.pxRatio=Pt;kn.join=uE;kn.fmtDate=hp,kn.tzDate=SE;kn.sync=nx;{kn.addGap=sA,kn.clipGaps=Kh;let i=kn.paths={points:lx};i.linear=hx,i.stepped=aA,i.bars=lA,i.spline=hA}var eu=class{constructor(e,t,n){this.plot=e;this.values=t.map(()=>X("span",{}));let s=t.map(({name:o,color:a},l)=>{let c=X("div",{},X("i",{},o),this.values[l]);return c.style.color=`var(${a})`,c}),r=X("div",{class:"list"},...s);r.style.gridTemplateRows=`repeat(${n}, auto)`,this.line.append(X("div",{class:"values"},this.time,r)),e.over.append(this.line)}plot;line=X("div",{class:"cursor",hidden:!0});time=X("b",{});values;show(e){let{data:t,scales:n}=this.plot,{min:s,max:r}=n.x,o=t[0].length-1,a=e!==null&&o>=0&&s!==void 0&&r!==void 0&&e>=s&&e<=r;if(this.line.hidden=!a||e<t[0][0]||e>t[0][o]+.1,this.line.hidden)return;let l=this.plot.valToPos(e,"x");this.line.style.transform=`translateX(${l}px)`,this.line.classList.toggle("left",l>this.plot.over.clientWidth/2),this.time.textContent=`${e.toFixed(2)} s`;let c=bA(t[0],e);this.values.forEach((h,u)=>h.textContent=SA(t[u+1][c]))}};function bA(i,e){let t=Math.min(Ff(i,e),i.length-1),n=Math.max(t-1,0);return e-i[n]<i[t]-e?n:t}function SA(i){if(i==null||!Number.isFinite(i))return"\u2013";let e=Math.abs(i)<100?2:0;return(Number(i.toFixed(e))+0).toFixed(e).replace("-","\u2212")}function px([i,e],t,n){return[t+(i-t)*n,t+(e-t)*n]}function mx([i,e],[t,n]){let s=(e-i)/Math.max(n-t,.001);return[i-t*s,i+(1-t)*s]}function MA([i,e],[t,n]){let s=Math.max(n-t,.2),r=Math.min(Math.max(e-i,.2),s),o=(i+e)/2,a=Math.min(Math.max(o-r/2,t),Math.max(n-r,t));return[a,a+r]}var tu=class{constructor(e,t){this.flown=e;this.now=t}flown;now;hovered=null;moment=null;zoomedTo=null;held=null;get shown(){let e=this.now();return this.held??this.zoomedTo??[e-20,e]}get cursor(){return this.hovered??this.moment}get isZoomed(){return this.zoomedTo!==null}zoom(e){this.zoomedTo=MA(e,this.flown())}follow(){this.zoomedTo=this.held=null}hold(){this.held=this.shown}release(){this.held=null}choose(e){if(this.moment=e,e===null)return;let[t,n]=this.shown;(e<t||e>n)&&this.zoom([e-(n-t)/2,e+(n-t)/2])}restart(){this.moment=this.hovered=null,this.follow()}};var wA=.0015,TA=16;function vx(i,e,t){let{over:n}=i,s=o=>EA(n,e,o),r=o=>{e.hovered=o,t.looked()};n.addEventListener("pointermove",({clientX:o,pointerType:a})=>{a==="mouse"&&r(s(o))}),n.addEventListener("pointerleave",()=>r(null)),n.addEventListener("pointerdown",({pointerType:o})=>{o==="mouse"&&AA(e)}),n.addEventListener("click",({clientX:o})=>t.chose(s(o))),n.addEventListener("dblclick",()=>{e.follow(),e.choose(null),r(null)}),n.addEventListener("wheel",o=>{if(Math.abs(o.deltaX)>Math.abs(o.deltaY))return;o.preventDefault();let a=o.deltaY*(o.deltaMode===WheelEvent.DOM_DELTA_LINE?TA:1);e.zoom(px(e.shown,s(o.clientX),Math.exp(wA*a))),t.looked()}),CA(n,e,s,()=>t.looked())}function xx(i,e){return{cursor:{x:!1,y:!1,points:{show:!1},drag:{x:!0,y:!1,dist:4,setScale:!1},bind:{dblclick:()=>null}},hooks:{setSelect:[n=>{let{left:s,width:r}=n.select;r<=0||(i.zoom([n.posToVal(s,"x"),n.posToVal(s+r,"x")]),n.setSelect({left:0,top:0,width:0,height:0},!1),e.looked())}]}}}function EA(i,{shown:[e,t]},n){let{left:s,width:r}=i.getBoundingClientRect();return e+(t-e)*(n-s)/r}function AA(i){i.hold(),document.addEventListener("mouseup",()=>setTimeout(()=>i.release()),{once:!0})}function CA(i,e,t,n){let s=null,r=l=>{if(s=null,l.touches.length!==2)return;l.preventDefault(),e.hold();let[c,h]=gx(l);s=[t(c),t(h)]},o=l=>{if(!s||l.touches.length!==2)return;l.preventDefault();let{left:c,width:h}=i.getBoundingClientRect(),[u,d]=gx(l);e.release(),e.zoom(mx(s,[(u-c)/h,(d-c)/h])),n()},a=()=>{s&&e.release(),s=null};i.addEventListener("touchstart",r,{passive:!1}),i.addEventListener("touchmove",o,{passive:!1}),i.addEventListener("touchend",a),i.addEventListener("touchcancel",a)}function gx({touches:i}){let[e,t]=[i[0].clientX,i[1].clientX];return[Math.min(e,t),Math.max(e,t)]}var vp="10px system-ui, sans-serif",xp=()=>Ha("--soft"),yx={stroke:()=>Ha("--grid"),width:1},_x=34,RA="0000 s",nu=class{constructor(e,t,n,s){this.window=n;let r=e.curves.flatMap(c=>c.label?[iu(c,c.label)]:[]).concat(e.keys??[]),o=X("header",{},X("b",{},e.title),e.more??X("small",{},e.unit));o.append(X("span",{class:"keys"},...r)),this.card=X("article",{class:"plot"},o,this.body);let a={...LA(e),...xx(n,s)};e.under&&(a.hooks.drawAxes=[e.under]);let l=()=>new kn(a,[[],...e.curves.map(()=>[])],this.body);this.plot=t==="light"?PA(l):l(),this.cursor=new eu(this.plot,e.curves,e.rows),vx(this.plot,n,s),this.sizes.observe(this.body)}window;card;body=X("div",{class:"canvas"});plot;cursor;sizes=new ResizeObserver(()=>this.fit());dirty=!0;remove(){this.sizes.disconnect(),this.plot.destroy(),this.card.remove()}update(e){this.dirty&&this.fit();let[t,n]=this.window.shown;this.plot.batch(()=>{this.plot.setData(e,!1),this.plot.setScale("x",{min:t,max:n})}),this.point()}point(){this.cursor.show(this.window.cursor)}fit(){let{clientWidth:e,clientHeight:t}=this.body;this.dirty=e<20,this.dirty||this.plot.setSize({width:e,height:t})}};function PA(i){let e=HTMLCanvasElement.prototype,{getContext:t}=e;e.getContext=function(n){return t.call(this,n,{willReadFrequently:!0})};try{return i()}finally{e.getContext=t}}function iu(i,e){let t=e.length>1,n=X(t?"i":"b",{class:i.dash?"dashed":i.name?"":"flight"},t?"":e);return n.style.color=`var(${i.color})`,i.alpha&&Object.assign(n.style,{borderTopWidth:`${i.width}px`,opacity:i.alpha}),X("span",{title:i.about},n,t?e:"")}function LA(i){return{width:200,height:100,legend:{show:!1},padding:[6,e=>Math.ceil(bx(e,[RA])/2)+1,0,0],scales:{x:{time:!1},y:{range:(e,t,n)=>FA(t,n,i)}},axes:[{stroke:xp,font:vp,grid:yx,ticks:{show:!1},size:18,gap:2,values:(e,t)=>t.map(DA)},{stroke:xp,font:vp,grid:yx,ticks:{show:!1},size:IA,gap:3,space:22}],series:[{},...i.curves.map(NA)]}}function IA(i,e,t,n){return n>1?i.axes[t]._size??_x:Math.max(_x,Math.ceil(bx(i,e??[]))+7)}function bx({ctx:i},e){i.save(),i.font=vp;let t=Math.max(0,...e.map(n=>i.measureText(n).width));return i.restore(),t}function NA({color:i,dash:e,width:t=1.5,alpha:n=1}){return{stroke:()=>Ha(i),width:t,alpha:n,points:{show:!1},...e&&{dash:e}}}var DA=i=>i<0?"":`${Number(i.toFixed(3))} s`;function FA(i,e,t){let{least:n,fromZero:s,headroom:r=.06}=t;if(i===null||e===null||!Number.isFinite(i+e))return[0,n];let o=Math.max(n-(e-i),0)/2,a=Math.max(e-i,n),[l,c]=[.06*a,r*a];return s?[0,Math.max(e,n)+c]:[i-o-l,e+o+c]}function su(i,e,t){let n=i.valToPos(e,"y",!0),{left:s,top:r,width:o,height:a}=i.bbox;if(n<r||n>r+a)return;let{ctx:l}=i;l.save(),l.strokeStyle=Ha(t),l.lineWidth=devicePixelRatio,l.setLineDash([4*devicePixelRatio,4*devicePixelRatio]),l.beginPath(),l.moveTo(s,n),l.lineTo(s+o,n),l.stroke(),l.restore()}function Sx(i,e,t,n,s){let{left:r,top:o,width:a,height:l}=i.bbox,c=f=>Math.min(Math.max(i.valToPos(f,"x",!0),r),r+a),[h,u]=[c(e),c(t)],{ctx:d}=i;d.save(),d.fillStyle=n,d.fillRect(h,o,u-h,l),d.fillStyle=xp(),d.textAlign="left",d.font=`${10*devicePixelRatio}px system-ui, sans-serif`,u-h>d.measureText(s).width+8&&d.fillText(s,h+4,o+11*devicePixelRatio),d.restore()}var OA=["--axis-x","--axis-y","--axis-z"],Mx=["x","y","z"],wx={dash:[4,3],width:1},Tx={width:4,alpha:.4},UA=6,Ex={name:"",color:"--soft"},kA=["--front-1","--front-2","--front-3","--front-4"],BA=["--rear-1","--rear-2","--rear-3","--rear-4"],nl=(i,e)=>[0,1,2].map(t=>i(`${e}${t}`)),il=i=>OA.map((e,t)=>({name:Mx[t],color:e,...i(Mx[t],t)})),ru=class{constructor(e,t,n,s,r,o,a,l=!1){this.scene=e;this.place=t;this.graphics=n;this.history=s;this.window=r;this.marks=o;this.chose=a;this.asError=l;this.threshold=e.threshold,this.all=[this.pushes(),this.tracking(),this.thrusts(),this.disturbance()],t.replaceChildren(...this.all.map(({plot:c})=>c.card))}scene;place;graphics;history;window;marks;chose;asError;threshold;all;turn=0;remove(){for(let{plot:e}of this.all)e.remove()}draw(){if(this.place.hidden||!Number.isFinite(this.history.flown[1]))return;this.turn=(this.turn+1)%this.all.length;let{plot:e,columns:t}=this.all[this.turn];this.history.show(this.window.shown),e.update([this.history.column("time"),...t()])}point(){for(let{plot:e}of this.all)e.point()}plot(e,t){let n=()=>this.point(),s=f=>new nu(f,this.graphics,this.window,{looked:n,chose:this.chose}),r=f=>t(m=>this.history.column(f+m));if(!this.scene.ghost||e.curves.length>UA)return{plot:s(e),columns:()=>r("")};let o=e.curves.map(({dash:f})=>!f),a=e.curves.filter((f,m)=>o[m]),l=a.map(f=>({...f,...Tx,name:Ns+f.name,label:""})),c=[iu(Ex,"now"),iu({...Ex,...Tx},"ghost")],h=s({...e,curves:[...l,...a],keys:c}),u=f=>r(f).filter((m,_)=>o[_]),d=f=>Array.from(f,m=>Number.isNaN(m)?null:m);return{plot:h,columns:()=>[...u(Ns).map(d),...u("")]}}pushes(){let e=il((r,o)=>({...wx,name:`pilot ${r}`,...o===2&&{label:"pilot"}})),t=il(r=>({label:r})),n=r=>{for(let o of new Set(this.threshold))su(r,o,"--level"),su(r,-o,"--level")},s={title:"Push",unit:"N",curves:[...e,...t],least:1.2,under:n,rows:3};return this.plot(s,r=>[...nl(r,"pilot_push"),...nl(r,"push")])}tracking(){let e=il((o,a)=>({...wx,name:`ref. ${o}`,...a===2&&{label:"ref."}})),t=il(o=>({label:o})),n=this.asError?"error":"position",s=Ri("What is shown",{position:"m",error:"\u0394 cm"},n,o=>{this.asError=o==="error"}),r={title:"Position",unit:"",curves:[...e,...t],least:.5,more:s,rows:3};return this.plot(r,o=>{let[a,l]=[nl(o,"reference"),nl(o,"position")];if(!this.asError)return[...a,...l];let c=l.map((h,u)=>h.map((d,f)=>100*(d-a[u][f])));return[...a.map(h=>new Float64Array(h.length)),...c]})}thrusts(){let{quadrotors:e}=this.scene.vehicle,t=e.flatMap((a,l)=>a.rotors.map((c,h)=>({name:`${4*l+h+1}`,color:(kh(a,h)?kA:BA)[l%4],width:1.2}))),n=new Set(e.flatMap(a=>a.rotors.map(l=>l.max_thrust))),s=a=>{for(let l of n)su(a,l,"--red")},o={title:"Thrusts",unit:"N",curves:t.map((a,l)=>({...a,...l===0&&{label:"front",about:"Rotors ahead of the middle of their quadrotor, left or right"},...l===1&&{label:"rear",about:"Rotors behind the middle of their quadrotor, left or right"}})),least:4,fromZero:!0,under:s,rows:4};return this.plot(o,a=>t.map((l,c)=>a(`thrusts${c}`)))}disturbance(){let n={title:"Disturbance, phase",unit:"N",curves:il(s=>({label:s})),least:1,under:s=>{for(let{from:r,to:o,phase:a}of this.marks.phases){let{tint:l,text:c}=Ch(this.scene.phases[a]);Sx(s,r,o,l,c)}},rows:3};return this.plot({...n,headroom:.3},s=>nl(s,"disturbance"))}};var zA=14,ou=class{constructor(e){this.choose=e;this.bar.addEventListener("input",()=>this.chooseNear(this.bar.valueAsNumber)),this.bar.addEventListener("pointerup",()=>this.bar.blur()),this.bar.addEventListener("keydown",()=>this.finger=!1),this.bar.addEventListener("pointerdown",({pointerType:t})=>this.finger=t==="touch"),this.element=X("div",{class:"timeline"},this.phases,this.window,this.bar,this.lane,this.words),this.element.addEventListener("pointerenter",({pointerType:t})=>this.still=t==="mouse"),this.element.addEventListener("pointerleave",()=>this.still=!1)}choose;element;bar=X("input",{type:"range",step:.01,"aria-label":"Time"});phases=X("div",{class:"phases"});lane=X("div",{class:"lane"});window=X("i",{class:"window"});words=X("p",{class:"words",hidden:!0});buttons=new Map;span=[0,1];still=!1;finger=!1;all=[];update(e,t,n,s,r){if(!Number.isFinite(e[0]+e[1]))return;(!this.still||e[1]<this.span[1])&&(this.span=e);let[o,a]=this.span;Object.assign(this.bar,{min:String(o),max:String(a),value:String(n)}),this.bar.setAttribute("aria-valuetext",`${n.toFixed(2)} s`),this.element.style.setProperty("--start",String(o)),this.element.style.setProperty("--length",String(Math.max(a-o,.01))),Cx(this.window,Math.max(t[0],o),Math.min(t[1],a)),this.showPhases(s,r),this.showMarks(s)}chooseNear(e){let[t,n]=this.span,s=zA*(n-t)/this.bar.clientWidth,r=a=>Math.abs(a.time-e),o=this.finger?this.all.filter(a=>r(a)<s).sort((a,l)=>r(a)-r(l))[0]:void 0;this.tell(o??null),this.choose(o?.time??e)}tell(e){this.words.hidden=e===null,e&&(this.words.textContent=Ax(e),this.words.style.setProperty("--at",String(e.time)))}showPhases({phases:e},t){for(;this.phases.childElementCount>e.length;)this.phases.lastElementChild.remove();e.forEach(({from:n,to:s,phase:r},o)=>{let a=this.phases.children[o]??this.phases.appendChild(X("i",{}));Cx(a,n,s),a.style.backgroundColor=Ch(t[r]).tint})}showMarks({all:e}){this.all=e;for(let[t,n]of this.buttons)e.includes(t)||(n.remove(),this.buttons.delete(t),this.words.hidden=!0);for(let t of e){let n=this.buttons.get(t)??this.newButton(t),s=Ax(t);n.ariaLabel!==s&&(n.ariaLabel=s)}}newButton(e){let t=X("button",{type:"button",class:`mark ${e.kind}`});t.style.setProperty("--at",String(e.time));let n=s=>this.tell(s?e:null);return t.addEventListener("pointerenter",()=>n(!0)),t.addEventListener("focus",()=>n(!0)),t.addEventListener("pointerleave",({pointerType:s})=>n(s!=="mouse")),t.addEventListener("blur",()=>n(!1)),t.addEventListener("click",()=>{n(!0),this.choose(e.time)}),this.buttons.set(e,t),this.lane.append(t),t}},Ax=({time:i,text:e})=>`${i.toFixed(1)} s: ${e}`;function Cx(i,e,t){i.style.setProperty("--at",String(e)),i.style.setProperty("--for",String(t-e))}var VA={full:30,light:110},Rx=5,GA=`Fly again to the chosen moment, or ${Rx} s back, and stand still there (R)`,HA=100,au=class{constructor(e,t){this.page=e;this.tell=t;this.window=new tu(()=>this.history.flown,()=>e.current?.scalar("time")??NaN),this.timeline=new ou(s=>this.choose(s)),this.back=Tt("play","Now","The last seconds, and no chosen moment",()=>{this.window.follow(),this.choose(null)});let n=Tt("rewind","Rewind",GA,()=>this.rewind());e.replay||Ke("time").replaceChildren(this.clock,this.timeline.element,this.back,n)}page;tell;timeline;window;scene=null;history=null;plots=null;marks=new $a;drawn=0;told=0;clock=X("output",{});back;get threshold(){return this.plots?.threshold??null}show(e){let{replay:t,graphics:n}=this.page;if(this.history?.continue(e)||([this.history,this.marks]=[new Dh(e),new $a]),this.scene=e,t)for(let a of t.frames())this.keep(a);this.marks.findings(e.replay?.findings??[]);for(let{time:a,text:l}of e.replay?.changes??[])this.marks.setting(a,l);let s=a=>this.choose(a),r=this.plots;r?.remove();let o=Ke("plots");this.plots=new ru(e,o,n,this.history,this.window,this.marks,s,r?.asError)}frame(e){this.page.replay||this.keep(e)}status({findings:e}){e&&this.marks.findings(e)}changed(e,t){let{page:n,scene:s,plots:r}=this;r&&e===To&&(r.threshold=yh(t));let o=s?.parameters.find(l=>l.key===e),a=`${o?.label??e} \u2192 ${Xa(t)} ${o?.unit??""}`;n.current&&this.marks.setting(n.current.scalar("time"),a.trim())}rewind(){let{window:e,page:t}=this;if(!t.current)return;let n=e.moment??Math.max(t.current.scalar("time")-Rx,0);t.send({type:"rewind",time:n}),this.tell(`Flown again to ${n.toFixed(2)} s, it stands still: take hold, then press Continue (P).`)}tick(e){let{page:t,window:n,scene:s,history:r}=this;if(e-this.drawn>VA[t.graphics]&&(this.plots?.draw(),this.drawn=e),e-this.told<HA||!t.current||!s||!r)return;this.told=e;let o=t.current.scalar("time"),a=t.replay?o:n.moment??o;this.timeline.update(r.flown,n.shown,a,this.marks,s.phases),this.clock.textContent=`${a.toFixed(2)} s`,this.back.hidden=n.moment===null&&!n.isZoomed}choose(e){e!==null&&this.page.replay?.seek(e),this.window.choose(e),this.plots?.point()}keep(e){this.history.add(e)&&(this.window.restart(),this.marks.cut(e.scalar("time"))),this.marks.frame(e)}};function WA(i,e){let t=i.slice(0,e).split(/\r?\n/);return[t.length,t.pop().length+1]}function XA(i,e,t){let n=i.split(/\r?\n/),s="",r=(Math.log10(e+1)|0)+1;for(let o=e-1;o<=e+1;o++){let a=n[o-1];a&&(s+=o.toString().padEnd(r," "),s+=":  ",s+=a,s+=`
`,o===e&&(s+=" ".repeat(r+t+2),s+=`^
`))}return s}var et=class i extends Error{line;column;codeblock;constructor(e,t){let[n,s]=WA(t.toml,t.ptr),r=XA(t.toml,n,s);super(`Invalid TOML document: ${e}

${r}`,t),this.line=n,this.column=s,this.codeblock=r}static x(e,t,n){throw new i(e,{toml:t.s,ptr:n??t.p})}};function lu(i){let e=i.p,t=i.s.charCodeAt(i.p++),n=t,s=t===39,r=t===i.s.charCodeAt(i.p)&&t===i.s.charCodeAt(i.p+1);r&&((t=i.s.charCodeAt(i.p+=2))===10?i.p++:t===13&&i.s.charCodeAt(i.p+1)===10&&(i.p+=2));let o="",a=i.p,l=0;for(;i.p<i.s.length;i.p++)if(t=i.s.charCodeAt(i.p),r&&(t===10||t===13&&i.s.charCodeAt(i.p+1)===10))l=l&&3;else if(t<32&&t!==9||t===127)et.x("control characters are not allowed in strings",i);else if((!l||l===3)&&t===n&&(!r||i.s.charCodeAt(i.p+1)===n&&i.s.charCodeAt(i.p+2)===n)){if(r&&(i.s.charCodeAt(i.p+3)===n&&i.p++,i.s.charCodeAt(i.p+3)===n&&i.p++),!l){let c=i.s.slice(a,i.p);o=o?o+c:c}return i.p+=r?3:1,o}else if(!l)!s&&t===92&&(o+=i.s.slice(a,a=i.p),l=1);else if(l===1)if(t===120||t===117||t===85){let c=i.p++-1,h=0,u=t===120?2:t===117?4:8;for(let d=0;d<u;d++,i.p++){let f=i.s.charCodeAt(i.p),m=f>=48&&f<=57?f-48:f>=65&&f<=70?f-65+10:f>=97&&f<=102?f-97+10:-1;m<0&&et.x("invalid non-hex character in unicode escape",i),h=h<<4|m}(h<0||h>1114111||h>=55296&&h<=57343)&&et.x("invalid unicode escape",i,c),o+=String.fromCodePoint(h),a=i.p--,l=0}else r&&(t===32||t===9)?l=2:(t===98?o+="\b":t===116?o+="	":t===110?o+=`
`:t===102?o+="\f":t===114?o+="\r":t===101?o+="\x1B":t===34?o+='"':t===92?o+="\\":et.x("unrecognised escape sequence",i),a=i.p+1,l=0);else t!==32&&t!==9&&(l===2&&et.x("invalid escape: only line-ending whitespace may be escaped",i,a),l=!s&&t===92?1:0,a=i.p);et.x("unfinished string",i,e)}var qA=/^(\d{4}-\d{2}-\d{2})?[Tt ]?(?:(\d{2}):\d{2}(?::\d{2}(?:\.\d+)?)?)?(Z|z|[-+]\d{2}:\d{2})?$/i,sl=class i extends Date{#t=!1;#n=!1;#e=null;constructor(e,t,n){let s=!0,r=!0,o="Z",a;if(typeof e=="string")if(t)e:{if(t<3){if(+e.slice(11,13)>23){e="";break e}t===2?(o=null,e+="Z"):(a=e.charCodeAt(e.length-1))!==90&&a!==122&&(o=e.slice(e.length-6)),n&&(e=e.slice(0,10)+"T"+e.slice(11))}else t===4&&(e=+e.slice(0,2)>23?"":`0000-01-01T${e}Z`);s=t!==4,r=t!==3}else{let l=e.match(qA);l?(l[1]||(s=!1,e=`0000-01-01T${e}`),r=!!l[2],r&&e[10]===" "&&(e=e.replace(" ","T")),l[2]&&+l[2]>23?e="":(o=l[3]||null,!o&&r&&(e+="Z"))):e=""}super(e),isNaN(this.getTime())||(this.#t=s,this.#n=r,this.#e=o)}isDateTime(){return this.#t&&this.#n}isLocal(){return!this.#t||!this.#n||!this.#e}isDate(){return this.#t&&!this.#n}isTime(){return this.#n&&!this.#t}isValid(){return this.#t||this.#n}toISOString(){let e=super.toISOString();if(this.isDate())return e.slice(0,10);if(this.isTime())return e.slice(11,23);if(this.#e===null)return e.slice(0,-1);if(this.#e==="Z"||this.#e==="z")return e;let t=+this.#e.slice(1,3)*60+ +this.#e.slice(4,6);return t=this.#e[0]==="-"?t:-t,new Date(this.getTime()-t*6e4).toISOString().slice(0,-1)+this.#e}static wrapAsOffsetDateTime(e,t="Z"){let n=new i(e);return n.#e=t,n}static wrapAsLocalDateTime(e){let t=new i(e);return t.#e=null,t}static wrapAsLocalDate(e){let t=new i(e);return t.#n=!1,t.#e=null,t}static wrapAsLocalTime(e){let t=new i(e);return t.#t=!1,t.#e=null,t}};function bi(i,e=10){return e===16?i>47&&i<58||i>64&&i<71||i>96&&i<103:i>47&&i<48+e}function _p(i,e){return i===32||i===9||i===10||i===13||e&&(i===e||i===44)||i===35}function ol(i,e){let t=i.p,n=i.s.charCodeAt(i.p);if(n===91||n===123){i.d--||et.x("document contains excessively nested structures. aborting.",i);let s=n===91?Ix(i):Lx(i);return i.d++,s}return n===34||n===39?lu(i):n===116?((i.s.charCodeAt(++i.p)!==114||i.s.charCodeAt(++i.p)!==117||i.s.charCodeAt(++i.p)!==101)&&et.x("invalid value",i,t),i.p++,!0):n===102?((i.s.charCodeAt(++i.p)!==97||i.s.charCodeAt(++i.p)!==108||i.s.charCodeAt(++i.p)!==115||i.s.charCodeAt(++i.p)!==101)&&et.x("invalid value",i,t),i.p++,!1):n===43||n===45?cu(i,i.p,i.s.charCodeAt(++i.p),44-n,e):i.s.charCodeAt(i.p+4)===45&&i.s.charCodeAt(i.p+7)===45?YA(i,n,e):i.s.charCodeAt(i.p+2)===58?$A(i,n,e):cu(i,i.p,n,0,e)}function cu(i,e,t,n,s){let r=t,o=0,a=!1;if(r===105)return(i.s.charCodeAt(++i.p)!==110||i.s.charCodeAt(++i.p)!==102)&&et.x("invalid value",i,e),i.p++,(n||1)/0;if(r===110)return(i.s.charCodeAt(++i.p)!==97||i.s.charCodeAt(++i.p)!==110)&&et.x("invalid value",i,e),i.p++,NaN;if(r===48){if(++i.p>=i.s.length||_p(r=i.s.charCodeAt(i.p),s))return i.bi===!0?0n:0;if(!n){if(r===120)return yp(i,e,16,s);if(r===98)return yp(i,e,2,s);if(r===111)return yp(i,e,8,s)}r===46?o=2:r===101||r===69?o=4:et.x("illegal leading zero",i,e)}else bi(r)||et.x("invalid value",i,e);for(;++i.p<i.s.length&&(r=i.s.charCodeAt(i.p),!_p(r,s));)o||(o=1),r===95?(o&1||et.x("illegal underscore",i),o+=11,a=!0):o===1&&r===46?o=2:(o===1||o===3)&&(r===101||r===69)?o=4:o===4&&(r===43||r===45)?o=6:bi(r)?o>9?o-=11:o&1||o++:et.x("illegal character in numeric literal",i);if(!o){let c=(t-48)*(n||1);return i.bi===!0?BigInt(c):c}o&1||et.x("unfinished numeric value",i,e);let l=i.s.slice(e,i.p);return a&&(l=l.replaceAll("_","")),o>1?parseFloat(l):Px(i,l,10,e)}function yp(i,e,t,n){let s,r=1;for(;++i.p<i.s.length&&(s=i.s.charCodeAt(i.p),!_p(s,n));)s===95?(r&1&&et.x("illegal underscore",i),r=3):bi(s,t)?r&1&&r--:et.x("illegal character in numeric literal",i);r&1&&et.x("unfinished numeric value",i);let o=i.s.slice(e+2,i.p);return r&&(o=o.replaceAll("_","")),Px(i,o,t,e)}function Px(i,e,t,n){if(i.bi!==!0)e:{let s=parseInt(e,t);if(!Number.isSafeInteger(s)){if(i.bi)break e;et.x("integer value cannot be represented losslessly",i,n)}return s}return BigInt(t===10?e:(t===2?"0b":t===8?"0o":"0x")+e)}function YA(i,e,t){let n=i.p++,s;if(!bi(e)||!bi(i.s.charCodeAt(i.p++))||!bi(i.s.charCodeAt(i.p++))||!bi(i.s.charCodeAt(i.p++)))return cu(i,i.p=n,e,0,t);if(i.p+=5,bi(i.s.charCodeAt(i.p++))||et.x("invalid date-time: date part is malformed",i,n),i.p>=i.s.length||((e=i.s.charCodeAt(i.p))!==32||(s=!0,!bi(i.s.charCodeAt(i.p+1))))&&e!==84&&e!==116){let o=i.s.slice(n,i.p);return rl(i,o,3,!1,n)}if(i.s.charCodeAt(i.p+=3)!==58&&et.x("invalid date-time: time part is malformed",i,n),i.s.charCodeAt(i.p+=3)===58&&(i.p+=3),i.s.charCodeAt(i.p)===46)for(;bi(i.s.charCodeAt(++i.p)););if(e=i.s.charCodeAt(i.p)){if(e===90||e===122){let o=i.s.slice(n,++i.p);return rl(i,o,1,s,n,"[+00:00]")}if(e===43||e===45){let o=i.s.slice(n,i.p+=6);return rl(i,o,1,s,n,!i.ld&&"["+i.s.slice(i.p-6,i.p)+"]")}}let r=i.s.slice(n,i.p);return rl(i,r,2,s,n)}function $A(i,e,t){let n=i.p;if(!bi(e)||!bi(i.s.charCodeAt(++i.p)))return cu(i,--i.p,e,0,t);if(i.s.charCodeAt(i.p+=4)===58&&(i.p+=3),i.s.charCodeAt(i.p)===46)for(;bi(i.s.charCodeAt(++i.p)););let s=i.s.slice(n,i.p);return rl(i,s,4,!1,n)}function rl(i,e,t,n,s,r){if(i.ld){let o=new sl(e,t,n);return o.isValid()||et.x("invalid date",i,s),o}try{switch(r&&(e+=r),t){case 1:return Temporal.ZonedDateTime.from(e);case 2:return Temporal.PlainDateTime.from(e);case 3:return Temporal.PlainDate.from(e);case 4:return Temporal.PlainTime.from(e)}}catch(o){et.x(o instanceof Error?o.message:""+o,i,s)}}function ZA(i){for(;i.p<i.s.length;i.p++){let e=i.s.charCodeAt(i.p);if(e===10)break;if(e===13&&i.s.charCodeAt(i.p+1)===10){i.p++;break}(e<32&&e!==9||e===127)&&et.x("control characters are not allowed in comments",i)}}function qi(i,e,t){let n;for(;i.p<i.s.length;){for(;i.p<i.s.length&&((n=i.s.charCodeAt(i.p))===32||n===9||!e&&(n===10||n===13&&i.s.charCodeAt(i.p+1)===10));)i.p++;if(t||n!==35)break;ZA(i)}}function hu(i,e=61){let t,n=0,s=[],r,o=i.s.charCodeAt(t=i.p);do{if(o===e)return n||et.x("unexpected end of key",i),n===1&&s.push(i.s.slice(r,i.p)),i.p++,s;o===46?(n||et.x("illegal empty bare key",i),n===1&&s.push(i.s.slice(r,i.p)),n=0):!n&&(o===34||o===39)?(o===i.s.charCodeAt(i.p+1)&&o===i.s.charCodeAt(i.p+2)&&et.x("illegal quoted key: multiline strings are not allowed",i),s.push(lu(i)),n=2,i.p--):o===32||o===9?n===1&&(s.push(i.s.slice(r,i.p)),n=2):n===2||o<48&&o!==45||o>57&&o<65||o>90&&o<97&&o!==95||o>122?et.x("illegal character in key",i):n||(n=1,r=i.p)}while(o=i.s.charCodeAt(++i.p));et.x("incomplete key-value: cannot find end of key",i,t)}function Lx(i){let e=i.p++,t=Object.create(null),n=new Set,s;for(;i.p<i.s.length;){if(qi(i),(s=i.s.charCodeAt(i.p))===125)return i.p++,t;let r,o=t,a=!1,l=i.p,c=hu(i);for(let u=0;u<c.length;u++){u&&(o=a?o[r]:o[r]=Object.create(null)),r=c[u],(a=Object.hasOwn(o,r))&&(typeof o[r]!="object"||n.has(o[r]))&&et.x("trying to redefine an already defined value",i,l);let d=r==="__proto__";if(i.uk&&(d||r==="constructor")){o=i.uk!==1&&et.x("document contains an unsafe property",i,l);break}!a&&d&&Object.defineProperty(o,r,{enumerable:!0,configurable:!0,writable:!0})}a&&et.x("trying to redefine an already defined value",i,l),qi(i,!0,!0);let h=ol(i,125);if(o&&typeof(o[r]=h)=="object"&&n.add(h),qi(i),(s=i.s.charCodeAt(i.p++))===125)return t;s!==44&&et.x("expected comma or end of structure",i,i.p-1)}et.x("unfinished table",i,e)}function Ix(i){let e=i.p++,t=[],n;for(;i.p<i.s.length;){if(qi(i),(n=i.s.charCodeAt(i.p))===93)return i.p++,t;if(t.push(ol(i,93)),qi(i),(n=i.s.charCodeAt(i.p++))===93)return t;n!==44&&et.x("expected comma or end of structure",i,i.p-1)}et.x("unfinished array",i,e)}function Nx(i,e,t,n,s){let r=t,o=n,a,l=!1,c;for(let h=0;h<e.length;h++){if(h){if(r=l?r[a]:r[a]=Object.create(null),o=(c=o[a]).c,s===0&&(c.t===1||c.t===2))return null;if(c.t===2){let u=r.length-1;r=r[u],o=o[u].c}}if(a=e[h],(l=Object.hasOwn(r,a))&&o[a]?.t===0&&o[a]?.d)return null;if(!l){let u=a==="__proto__";if(i.uk&&(u||a==="constructor"))return!1;u&&(Object.defineProperty(r,a,{enumerable:!0,configurable:!0,writable:!0}),Object.defineProperty(o,a,{enumerable:!0,configurable:!0,writable:!0})),o[a]={t:h<e.length-1&&s===2?3:s,d:!1,i:0,c:Object.create(null)}}}if(c=o[a],c.t!==s&&!(s===1&&c.t===3)||(s===2&&(c.d||(c.d=!0,r[a]=[]),r[a].push(r=Object.create(null)),c.c[c.i++]=c={t:1,d:!1,i:0,c:Object.create(null)}),c.d))return null;if(c.d=!0,s===1)r=l?r[a]:r[a]=Object.create(null);else if(s===0&&l)return null;return[a,r,c.c]}function Dx(i,e,t){(e===null||i.uk===2)&&et.x(e===null?"trying to redefine an already defined table or value":"document contains an unsafe property",i,t)}function bp(i,e={}){let t={s:i,p:0,d:e.maxDepth??1e3,bi:e.integersAsBigInt??!1,ld:e.useLegacyDate??!0,uk:e.unsafeKeyBehaviour==="throw"?2:e.unsafeKeyBehaviour==="drop"?1:0},n=Object.create(null),s=Object.create(null),r,o=!1,a=n,l=s;for(i.charCodeAt(0)===65279&&t.p++,qi(t);t.p<i.length;){if(i.charCodeAt(t.p)===91){let c=i.charCodeAt(++t.p)===91;r=t.p+=+c,o=!1;let h=hu(t,93);c&&(i.charCodeAt(t.p)!==93&&et.x("expected end of table array declaration",t),t.p++);let u=Nx(t,h,n,s,c?2:1);u?(l=u[2],a=u[1]):(Dx(t,u,r),o=!0)}else{r=t.p;let c=hu(t),h=Nx(t,c,a,l,0);!h&&!o&&Dx(t,h,r),qi(t,!0,!0);let u=ol(t,void 0);h&&!o&&(h[1][h[0]]=u)}qi(t,!0),t.p<i.length&&(r=i.charCodeAt(t.p))!==10&&(r!==13||i.charCodeAt(t.p+1)!==10)&&et.x("each key-value declaration must be followed by an end-of-line",t),qi(t)}return n}var WN=!!"".isWellFormed;var fs=class extends Error{},uu=(...i)=>[`one of ${i.join(", ")}`,e=>i.includes(e)],du=i=>typeof i=="object"&&!Array.isArray(i)&&!(i instanceof Date),Mp=i=>[`a text of 1 to ${i} characters`,e=>typeof e=="string"&&e.trim()!==""&&e.length<=i],KA=i=>Array.isArray(i)&&i.every(Number.isFinite),JA={title:Mp(80),mission:Mp(100),steps:["one table [[steps]] or more",i=>Array.isArray(i)&&i.length>0&&i.every(du)]},jA={text:Mp(400),spotlight:uu(...Ya.spotlight),camera:uu(...Ya.camera),settings:["a table of keys of the mission",du],push:["a table with force and duration, as { force = [2, 0, 0], duration = 1.0 }",du],ask:uu(...Ya.ask),ghost:uu(...Ya.ghost),pause:["true or false",i=>typeof i=="boolean"]},Fx={force:["three numbers, N",i=>KA(i)&&i.length===3],duration:["from 0.1 to 60 s",i=>typeof i=="number"&&i>=.1&&i<=60]},Ox=i=>/^\s*(\[\[\s*steps\s*\]\]|steps\s*=)/m.test(i);function Ux(i){let e=QA(i);Sp("",e,JA,["steps"]);let t=e.steps.map((n,s)=>{let r=`step ${s+1}: `;return Sp(r,n,jA,["text"]),n.push&&Sp(`${r}push.`,n.push,Fx,Object.keys(Fx)),{...n,settings:Bx(n.settings??{})}});return{...e,steps:t}}function kx({steps:i},e){if(e.replay)throw new fs("a saved flight follows no script: open it in a page that flies");let t=e.spring.max_force;i.forEach(({settings:n,push:s},r)=>{let o=`step ${r+1}: `;for(let[l,c]of Object.entries(n))eC(`${o}settings.${l}`,l,c,e);t=Number(n[qa]??t);let a=`${t} N at most, which ${qa} sets`;s&&Zt(s.force)>t&&ko(`${o}push.force`,s.force,a)})}function QA(i){try{return bp(i)}catch(e){let{line:t,column:n,message:s}=e;throw new fs(`line ${t}, column ${n}: ${s.split(`
`)[0]}`)}}function Sp(i,e,t,n){for(let s of n)if(!(s in e))throw new fs(`${i}${s} is missing: must be ${t[s][0]}`);for(let[s,r]of Object.entries(e)){let o=Object.keys(t).join(", ");if(!(s in t))throw new fs(`${i}${s} is no key here: must be one of ${o}`);t[s][1](r)||ko(`${i}${s}`,r,t[s][0])}}function eC(i,e,t,{mission:n,parameters:s}){let r=s.find(_=>_.key===e),o=s.map(_=>_.key).join(", ");if(!r)throw new fs(`${i}: cannot change in flight of ${n}; must be one of ${o}`);let{choices:a,min:l=-1/0,max:c=1/0,value:h}=r;if(a){a.includes(t)||ko(i,t,`one of ${a.join(", ")}`);return}let u=Array.isArray(h)?h.length:1,d=[t].flat(),f=d.every(_=>typeof _=="number"&&_>=l&&_<=c),m=u>1?`a number, or ${u}, from`:"a number from";(!f||Array.isArray(t)&&d.length!==u)&&ko(i,t,`${m} ${l} to ${c}`)}function ko(i,e,t){throw new fs(`${i} = ${JSON.stringify(e)}: must be ${t}`)}function Bx(i,e=""){let t=Object.entries(i).map(([n,s])=>du(s)?Bx(s,`${e}${n}.`):{[e+n]:s});return Object.assign({},...t)}var tC=.05,[zx,Vx]=[400,100],Tp={push:Bo("push","N",2,"push"),moment:Bo("moment of the push","N m",2,"push_moment"),speed:Bo("speed","m/s",2,"velocity"),x:{name:"position x",unit:"m",digits:2,of:i=>i.vector("position")[0]},y:{name:"position y",unit:"m",digits:2,of:i=>i.vector("position")[1]},height:{name:"height",unit:"m",digits:2,of:i=>i.vector("position")[2]},error:{name:"distance from the reference",unit:"cm",digits:1,of:nC},disturbance:Bo("estimated disturbance","N",2,"disturbance"),thrust:{name:"largest thrust",unit:"N",digits:1,of:i=>Math.max(...i.list("thrusts"))},contact:Bo("force of the walls","N",1,"contact_force"),wind:Bo("wind","m/s",1,"wind"),time:{name:"time",unit:"s",digits:1,of:i=>i.scalar("time")}},fu=Object.keys(Tp);function Bo(i,e,t,n){return{name:i,unit:e,digits:t,of:s=>Zt(s.vector(n))}}function nC(i){return 100*Zt(ii(i.vector("position"),i.vector("reference")))}var pu=class{element=X("div",{class:"spotlight"});menu=X("select",{"aria-label":"Quantity in the spotlight"});value=X("b");unit=X("span");ghost=X("p",{class:"ghost"});curves=["ghost","own"].map(e=>gi("polyline",{class:e,points:""}));frames=[];constructor(){this.menu.append(...fu.map(t=>X("option",{value:t},Tp[t].name))),this.menu.addEventListener("change",()=>this.menu.blur());let e=gi("svg",{viewBox:`0 0 ${zx} ${Vx}`,preserveAspectRatio:"none"},...this.curves);this.element.append(this.menu,X("p",{class:"value"},this.value,this.unit),this.ghost,e)}show(e){this.menu.value=e}turn(e){this.show(fu[(this.menu.selectedIndex+e+fu.length)%fu.length])}frame(e){let t=e.scalar("time"),n=t-(this.frames.at(-1)?.scalar("time")??-1);if(n<0||n>20)this.frames=this.frames.filter(s=>t-s.scalar("time")>0);else if(n<tC)return;for(this.frames.push(e);this.frames[0].scalar("time")<t-20;)this.frames.shift()}draw(e){let{unit:t,digits:n,of:s}=Tp[this.menu.value],r=f=>Number(s(f).toFixed(n))+0,o=f=>r(f).toFixed(n).replace("-","\u2212");[this.value.textContent,this.unit.textContent]=[o(e),t],this.ghost.textContent=e.ghost?`ghost ${o(e.ghost)}`:"";let a=this.frames.map(f=>f.ghost?s(f.ghost):NaN),l=this.frames.map(s),c=[...a,...l].filter(Number.isFinite),[h,u]=[Math.min(0,...c),Math.max(.001,...c)],d=e.scalar("time");[a,l].forEach((f,m)=>{let _=f.flatMap((g,p)=>{let y=zx*(1-(d-this.frames[p].scalar("time"))/20),A=Vx*(1-(g-h)/(u-h));return Number.isFinite(g)?[`${y.toFixed(1)},${A.toFixed(1)}`]:[]});this.curves[m].setAttribute("points",_.join(" "))})}};var[iC,sC]=[["PageDown","ArrowRight","ArrowDown","Space"],["PageUp","ArrowLeft","ArrowUp"]],rC="Page Down and Page Up change the quantity. Drop a script (.toml) for the steps of a lecture.",oC=100,mu=class{constructor(e,t){this.page=e;this.actions=t;let n=X("nav",{},Tt("open","Script","Open the script of a lecture: a .toml file",t.choose),Tt("back","Back","The step before (Page Up)",()=>this.turn(-1)),Tt("play","Next","The next step (Page Down, space)",()=>this.turn(1)),Tt("close","Leave","Back to the whole page (T, Escape)",()=>this.toggle()));n.addEventListener("click",()=>document.activeElement.blur());let s=X("div",{class:"words"},X("header",{},this.title,n),this.text);this.element=X("section",{id:"lecture",hidden:!0},s,this.spotlight.element),Ke("view").after(this.element),window.addEventListener("keydown",this.key,{capture:!0}),document.addEventListener("fullscreenchange",()=>{this.on&&!document.fullscreenElement&&this.toggle()})}page;actions;button=Tt("screen","Lecture, full screen (T)","Large type, a script",()=>this.toggle());scene;spotlight=new pu;title=X("span");text=X("p",{class:"text",role:"status"});element;script=null;waiting=null;at=-1;given=document.getElementById("script")?.textContent;push=null;drawn=0;toggle(){let e=!this.on;this.element.hidden=!e,document.body.classList.toggle("lecture",e),this.tell(),e?Gx():this.release(),!e&&document.fullscreenElement&&document.exitFullscreen()}load(e,t){this.unlessWrong(e,()=>{let n=Ux(t),{mission:s=this.scene.mission}=n,r=this.page.companions?.map(o=>o.name).concat(this.scene.mission);r&&!r.includes(s)&&ko("mission",s,`one of this page: ${r.join(", ")}`),s===this.scene.mission?this.begin(e,n):(this.waiting=[e,n],this.page.send({type:"fly",mission:s}))})}begun(){if(this.push=null,this.waiting?.[1].mission!==this.scene.mission)return;let[e,t]=this.waiting;this.waiting=null,this.unlessWrong(e,()=>this.begin(e,t))}status({preparing:e}){if(e||!this.given)return;let{name:t,text:n}=JSON.parse(this.given);this.given=void 0,this.load(t,n)}frame(e){this.spotlight.frame(e);let t=e.scalar("time");this.push&&(t>=this.push.until||t<this.push.from)&&this.release()}tick(e){!this.on||e-this.drawn<oC||!this.page.current||(this.drawn=e,this.spotlight.draw(this.page.current))}get on(){return!this.element.hidden}unlessWrong(e,t){try{t()}catch(n){if(!(n instanceof fs))throw n;this.actions.tell("This script is not shown",`${e}: ${n.message}`)}}begin(e,t){kx(t,this.scene),[this.script,this.at]=[{title:e,...t},-1],this.turn(1),this.on||this.toggle()}turn(e){let{steps:t}=this.script??{};t?t[this.at+e]&&(this.at+=e,this.go(t,e>0)):this.spotlight.turn(e),this.tell()}go(e,t){let{page:n,scene:s}=this,r=e.slice(0,this.at+1),{pause:o=!1,push:a,ask:l,ghost:c}=r.at(-1);this.release(),t&&c?n.compare?.(c):!t&&s.ghost&&Ep(r,"ghost")!=="keep"&&n.compare?.("end"),this.set(e,r),this.spotlight.show(Ep(r,"spotlight")??"push");let h=r.at(-1).camera??(t?void 0:Ep(r,"camera"));if(h&&this.actions.look(h),n.send({type:"pause",on:o}),t&&l&&n.send({type:"ask",what:l}),!t||!a)return;let u=n.current?.scalar("time")??0;this.push={from:u,until:u+a.duration},n.send({type:"force",force:a.force,point:[0,0,0]})}set(e,t){let n=Object.assign({},...t.map(({settings:s})=>s));for(let{key:s,value:r,initial:o=r}of this.scene.parameters){if(!e.some(({settings:c})=>s in c))continue;let a=n[s]??o,l=Array.isArray(r)&&typeof a=="number"?r.map(()=>a):a;vi(l,r)||this.page.send({type:"set",key:s,value:l})}}release(){this.push&&this.page.send({type:"force",force:[0,0,0],point:[0,0,0]}),this.push=null}tell(){let{title:e="",steps:t}=this.script??{};this.title.textContent=t?`${e} \xB7 ${this.at+1} of ${t.length}`:"Lecture",this.text.textContent=t?t[this.at].text:rC}key=e=>{if(!this.on||Va(e)||e.ctrlKey||e.metaKey||e.altKey)return;e.code==="Escape"&&this.toggle();let t=Number(iC.includes(e.code))-Number(sC.includes(e.code));!t||e.code==="Space"&&e.target.matches("button, input")||(e.preventDefault(),e.stopImmediatePropagation(),!e.repeat&&(document.fullscreenElement||Gx(),this.turn(t)))}};function Ep(i,e){return i.filter(t=>t[e]!==void 0).at(-1)?.[e]}function Gx(){let i=document.documentElement;i.requestFullscreen?.call(i).catch(()=>{})}var zo=class{menu;constructor(e,t){let n=e.map(({name:s,title:r})=>X("option",{value:s,title:r},s));this.menu=nr({id:"missions",title:"Mission","aria-label":"Mission"},t,!0,n),Ke("mission").hidden=!0,Ke("mission").after(this.menu)}show(e){[...this.menu.options].some(({value:n})=>n===e)||this.menu.prepend(X("option",{value:e},e)),this.menu.value=e}};var Hx=100,aC="only a page of tandemlift live flies files",gu=class{constructor(e,t,n,s){this.send=e;this.notices=t;this.question=n;this.script=s;window.addEventListener("dragover",this.drag),window.addEventListener("dragleave",this.drag),window.addEventListener("drop",this.drop)}send;notices;question;script;menu=null;flown="";loading=null;get open(){return this.menu!==null}scene({missions:e,mission:t}){let n=s=>this.fly({type:"fly",mission:s});e&&(this.menu??=new zo(e,n)),this.flown=t,this.menu?.show(t)}choose(){let e=X("input",{type:"file"});e.addEventListener("change",()=>{this.take(e.files)}),e.click()}done(e){this.loading?.remove(),this.notices.show(`Flying ${e}`,"done")}refused(e){this.menu?.show(this.flown),this.loading?.remove(),this.question.tell("This mission is not flown",e)}fly(e){if(new TextEncoder().encode(JSON.stringify(e)).length>65536-Hx){this.refused(`${e.mission}: is longer than ${65536} bytes, the most that is flown here`);return}this.loading?.remove(),this.loading=this.notices.show(`Loading ${e.mission} \u2026`,"done"),this.send(e)}async take(e){let t=e?.item(0);if(!t)return;if(e.length>1){this.refused(`${t.name} and ${e.length-1} more: one file at a time`);return}let n=t.name.slice(-Hx);try{let s=await t.slice(0,65536).text();Ox(s)?this.script(n,s):this.open?this.fly({type:"fly",mission:n,toml:s}):this.refused(`${n}: ${aC}`)}catch{this.refused(`${n}: cannot be read`)}}drag=e=>{e.dataTransfer?.types.includes("Files")&&(e.preventDefault(),document.body.classList.toggle("dropping",e.type==="dragover"))};drop=e=>{document.body.classList.remove("dropping");let t=e.dataTransfer?.files;t?.length&&(e.preventDefault(),this.take(t))}};var lC=6e3,cC=4,vu=class{place=Ke("notices");banner=Ke("lost");timer=0;constructor(e){Ke("retry").addEventListener("click",e)}show(e,t){[...this.place.children].find(r=>r.textContent===e)?.remove();let s=X("p",{class:t},e);for(s.addEventListener("click",()=>s.remove()),this.place.append(s);this.place.children.length>cC;)this.place.firstElementChild?.remove();return window.setTimeout(()=>s.remove(),lC),s}explain(e){let t=X("p",{class:"refused"},e);t.addEventListener("click",()=>t.remove()),this.place.append(t)}disconnected(e){this.banner.hidden=!1,document.body.classList.add("lost"),window.clearInterval(this.timer);let t=()=>{let n=Math.ceil((e-performance.now())/1e3);Ke("lost-wait").textContent=n>0?`Trying again in ${n} s.`:"Trying again \u2026"};t(),this.timer=window.setInterval(t,250)}connected(){window.clearInterval(this.timer),this.banner.hidden=!0,document.body.classList.remove("lost")}};var hC={3:["x","y","z"],4:["x","y","z","yaw"],6:["x","y","z","roll","pitch","yaw"]},uC=["admittance.mass","admittance.damping",To],xu=new Set,dC=2e3,yu=class{constructor(e,t){this.parameter=e;this.send=t;this.value=e.value,this.initial=e.initial??e.value;let n=X("button",{type:"button",class:"back",title:"Restore the mission's value"},Gi("back"));n.addEventListener("click",()=>t({type:"restore",key:e.key}));let s=X("small",{},e.unit??""),r=X("div",{class:"name",title:e.key},X("span",{},e.label),s);r.append(...uC.includes(e.key)?[this.lock()]:[],n),this.fields=this.makeFields();let o=X("div",{class:"fields"},...this.fields.map(({row:a})=>a));this.element=X("div",{class:"parameter","data-key":e.key},r,o,this.reason),this.show(e.value)}parameter;send;element;value;asked=null;askedAt=0;initial;fields;reason=X("p",{class:"reason"});begin(e){let t=this.asked!==null||!vi(this.value,e);this.refuse(""),t&&this.show(e)}changed(e,t){this.asked!==null&&performance.now()-this.askedAt<dC&&!vi(this.asked,e)||(this.refuse(""),this.show(e),this.element.classList.add("ramping"),window.setTimeout(()=>this.element.classList.remove("ramping"),1e3*t))}refuse(e){this.asked=null,this.reason.textContent=e,this.element.classList.toggle("refused",e!==""),e&&this.show(this.value)}show(e){this.value=e;let t=[e].flat();this.fields.forEach((n,s)=>n.show(t[s])),this.element.classList.toggle("altered",!vi(e,this.initial))}makeFields(){let{value:e,choices:t}=this.parameter;if(t)return[this.select(t)];if(typeof e=="boolean")return[this.checkbox()];let n=[e].flat(),s=hC[n.length]??n.map((r,o)=>String(o+1));return n.map((r,o)=>this.number(o,n.length>1?s[o]:""))}lock(){let{key:e}=this.parameter;return Ga("x = y = z",xu.has(e),t=>{t?xu.add(e):xu.delete(e);let[n,...s]=[this.value].flat();t&&s.slice(0,2).some(r=>r!==n)&&this.enter(0,n)})}select(e){let t=e.map(s=>X("option",{value:s},s)),n=X("select",{"aria-label":this.parameter.label},...t);return n.addEventListener("change",()=>this.set(e[n.selectedIndex])),{row:n,show:s=>n.value=String(s)}}checkbox(){let e=X("input",{type:"checkbox"});return e.addEventListener("change",()=>this.set(e.checked)),{row:X("label",{class:"toggle"},e,X("span",{},"on")),show:n=>e.checked=n===!0}}number(e,t){let[n,s]=[this.parameter.min,this.parameter.max],r=`${this.parameter.label} ${t}`.trim(),o=X("input",{type:"number",step:"any",min:n,max:s,"aria-label":r}),a=d=>{o.value!==""&&Number.isFinite(d)?this.enter(e,d):this.refuse(`${r}: ${o.value||"what was entered"} is no finite number`)};o.addEventListener("change",()=>a(Number(o.value)));let l=n!==void 0&&s!==void 0&&s>n?new wh(n,s):null,c=X("input",{type:"range",min:0,max:1e3,"aria-label":`${r}, slider`,disabled:!l});return c.addEventListener("input",()=>o.value=Th(l.value(c.valueAsNumber))),c.addEventListener("change",()=>a(l.value(c.valueAsNumber))),{row:X("div",{class:"number"},X("span",{class:`axis ${t}`},t),c,o),show:d=>{o.defaultValue=o.value=Th(Number(d)),c.value=String(l?.place(Number(d))??0)}}}set(e){this.send({type:"set",key:this.parameter.key,value:e})}enter(e,t){let n=this.asked??this.value,s=xu.has(this.parameter.key)&&e<3,r=o=>o===e||s&&o<3;this.asked=Array.isArray(n)?n.map((o,a)=>r(a)?t:o):t,this.askedAt=performance.now(),this.set(this.asked)}};var fC=3e3,_u=class{constructor(e,t){this.send=t;let{quadrotors:n,payload:s}=e.vehicle;this.maxThrusts=n.flatMap(c=>c.rotors.map(h=>h.max_thrust));let r=Math.max(s.length/2,...n.map(c=>Math.abs(c.position[1])+c.guard))+.05,o=Math.max(.2,...n.map(c=>Math.abs(c.position[0])+c.guard))+.05,a=[-r,-o,2*r,2*o].join(" "),l=gi("svg",{viewBox:a,class:"rotormap"},pC(s));for(let c of n){let[h,u]=c.position;l.append(gi("circle",{class:"guard",cx:-u,cy:-h,r:c.guard})),c.rotors.forEach((d,f)=>l.append(this.rotor(c,f)))}this.element=X("div",{class:"rotors"},l,this.note),this.arm(-1),this.markFailed([])}send;element;fills=[];buttons=[];maxThrusts;note=X("p",{class:"note",role:"status"});armed=-1;timer=0;showThrusts(e){this.fills.forEach((t,n)=>{t.setAttribute("fill-opacity",Math.min(e[n]/this.maxThrusts[n],1).toFixed(2))})}markFailed(e){this.buttons.forEach((t,n)=>{let s=e.includes(n);t.classList.toggle("failed",s),t.setAttribute("aria-disabled",String(s)),t.setAttribute("aria-label",s?`Rotor ${n+1}, stopped`:`Stop rotor ${n+1}`)})}rotor(e,t){let{position:n,radius:s}=e.rotors[t],r=this.buttons.length,o={cx:-n[1],cy:-n[0],r:.92*s},a=gi("circle",{...o,class:kh(e,t)?"front":"rear"}),l=gi("circle",{...o,class:"rim"}),c=.5*s,h=2*c,u=`M${o.cx-c} ${o.cy-c}l${h} ${h}m0 ${-h}l${-h} ${h}`,d=gi("g",{role:"button",tabindex:0},a,l,gi("path",{d:u}));return d.addEventListener("click",()=>this.press(r)),d.addEventListener("keydown",f=>{f.key!=="Enter"&&f.key!==" "||(f.preventDefault(),this.press(r))}),this.fills.push(a),this.buttons.push(d),d}press(e){if(!this.buttons[e].classList.contains("failed")){if(window.clearTimeout(this.timer),this.armed===e){this.send({type:"kill",rotor:e}),this.arm(-1);return}this.arm(e),this.timer=window.setTimeout(()=>this.arm(-1),fC)}}arm(e){this.armed=e,this.buttons.forEach((t,n)=>t.classList.toggle("armed",n===e)),this.note.textContent=e<0?"Press a rotor twice to stop it.":`Press rotor ${e+1} again to stop it for good.`}};function pC({length:i,width:e,position:t}){let n=Math.max(e,.06);return gi("rect",{class:"beam",x:-i/2-t[1],y:-n/2,width:i,height:n})}var bu=class{constructor(e,t,n){this.place=e;this.page=t;this.undo=n}place;page;undo;editors=new Map;rotors=null;open={};built="";force=null;planes=null;initial={mission:"",values:new Map};scene(e){let t=this.remembered(e),n=JSON.stringify([e.vehicle,t.map(s=>({...s,value:null}))]);n!==this.built&&this.build(e,t),this.built=n;for(let{key:s,value:r}of t)this.editors.get(s).begin(r);this.force?.limit(e.spring.max_force)}build(e,t){for(let a of this.place.querySelectorAll("details"))this.open[a.dataset.name??""]=a.open;let n=!e.replay,s=this.page.send.bind(this.page);this.editors=new Map(t.map(a=>[a.key,new yu(a,s)])),this.rotors=n?new _u(e,s):null;let o=[...new Set(e.parameters.map(({group:a})=>a))].map(a=>{let l=e.parameters.filter(({group:c})=>c===a).map(({key:c})=>c);return this.group(a,l.map(c=>this.editors.get(c).element))});this.place.replaceChildren(...n?[this.group("hand",this.hand(),!0)]:[],...o,...o.length?[this.undo,this.restoreAll()]:[],...this.rotors?[this.group("rotors",[this.rotors.element])]:[],this.group("picture",this.picture(),!n),...this.page.extra)}challenged(e){let{hand:t}=this.page;t.planeChosen||(t.plane=e?"level":"facing",this.planes&&d0(this.planes,e?1:0))}showThrusts(e){this.rotors?.showThrusts(e)}markFailed(e){this.rotors?.markFailed(e)}changed(e,t,n){this.editors.get(e)?.changed(t,n),e===qa&&this.force?.limit(Number(t))}refused(e,t){let n=this.editors.get(e.replace(/^(set|restore) /,""));return n?.refuse(t),n!==void 0}remembered({mission:e,parameters:t}){e!==this.initial.mission&&(this.initial={mission:e,values:new Map});let{values:n}=this.initial;return t.map(s=>(n.has(s.key)||n.set(s.key,s.initial??s.value),{...s,initial:n.get(s.key)}))}group(e,t,n=!1){let s=X("summary",{},e);return X("details",{open:this.open[e]??n,"data-name":e},s,...t)}hand(){let{rows:e,force:t,planes:n}=C0(this.page.hand);return[this.force,this.planes]=[t,n],e}picture(){let e=Ri("Graphics",{auto:"auto",full:"full",light:"light"},this.page.graphicsChoice,s=>{this.page.setGraphics(s)}),n=Ri("Colours",{auto:"automatic",light:"light",dark:"dark"},this.page.theme,s=>this.page.setTheme(s));return[Tr("Graphics",e),Tr("Colours",n)]}restoreAll(){let e=X("button",{type:"button",class:"restore-all"},Gi("back"),"Restore all values");return e.addEventListener("click",()=>this.page.send({type:"restore"})),e}};var Su=class{dialog=Ke("question");asking=!1;ask(e,t,n,s){let r=this.button("Cancel","");this.show(e,t,r,this.button(n,"alarm",s)),this.asking=!0,r.focus()}tell(e,t){this.show(e,t,this.button("Close","go"))}withdraw(){this.asking&&this.dialog.close()}button(e,t,n){let s=X("button",{type:"button",class:t},e);return s.addEventListener("click",()=>{this.dialog.close(),n?.()}),s}show(e,t,...n){let{dialog:s}=this;this.asking=!1,s.onclick=o=>{o.target===s&&s.close()};let r=X("h2",{id:"question-title"},e);s.replaceChildren(r,X("p",{},t),X("div",{class:"actions"},...n)),s.open||s.showModal()}};var mC=["0.1","0.25","0.5","1","2","4"],gC=1,Mu=class{constructor(e,{end:t,speed:n},s,r,o){this.flight=s;this.player=Tt("pause","","Play or pause (P)",()=>this.toggle());let a=mC.map(u=>X("option",{value:u,selected:Number(u)===n},`\xD7${u}`)),l=nr({"aria-label":"Speed"},u=>s.setSpeed(Number(u)),!1,a),c=Tt("video","Video","Record a video of the picture",o,"film"),h=X("output",{},this.clock,X("span",{},` / ${t.toFixed(1)} s`));e.replaceChildren(X("div",{class:"strip player"},this.player,r,h,l,c))}flight;clock=X("b",{});player;playing=!0;time=0;toggle(){this.flight.play(!this.flight.playing)}step(e){this.flight.seek(this.time+e*gC)}update(e){this.time=e,this.clock.textContent=e.toFixed(2),this.playing!==this.flight.playing&&(this.playing=this.flight.playing,this.player.firstElementChild.replaceWith(Gi(this.playing?"pause":"play")))}};var wu=class{constructor(e){this.save=e;let t=X("button",{type:"button"},"Cancel");t.addEventListener("click",()=>this.dialog.close());let n=X("h2",{id:"saving-title"},"Save the flight so far"),s=X("div",{class:"actions"},t,this.submit),r=X("label",{for:"save-name"},"Name"),o=X("form",{},n,r,this.name,this.reason,s);this.name.setAttribute("aria-describedby","save-reason"),this.name.addEventListener("input",()=>this.show("")),o.addEventListener("submit",a=>{a.preventDefault(),this.show("",!0),this.save(this.name.value)===null&&this.refused("No flight is open now: nothing was saved.")}),this.dialog.replaceChildren(o)}save;dialog=Ke("saving");name=X("input",{type:"text",id:"save-name",autocomplete:"off",spellcheck:"false"});reason=X("p",{class:"reason",role:"alert",id:"save-reason"});submit=X("button",{type:"submit",class:"go"},"Save");open(e){this.name.value=e,this.show(""),this.dialog.showModal(),this.name.select()}done(){this.dialog.close()}refused(e){return this.dialog.open?(this.show(e),this.name.focus(),!0):!1}show(e,t=!1){this.reason.textContent=e,this.name.setAttribute("aria-invalid",String(e!=="")),this.submit.disabled=t,this.submit.textContent=t?"Saving \u2026":"Save"}};var Wx=.22,Xx=.05,qx=new U(0,0,1),[Cp,Rp]=[.17,.012],[vC,xC,Pp]=[1.2,.5,1.75*Math.PI],[Tu,al]=[56,6];function Ip(i,e){let t=i.map((n,s)=>n===0?1/0:e[s]/Math.abs(n));return Zt(i)*Math.min(...t)}function Yx(i,e){let t=o=>o.toFixed(o<1?2:1),n=i.map((o,a)=>Math.abs(o)/e[a]),s=Math.max(...n);if(s>1)return`${t(Zt(i))} N`;let r=n.indexOf(s);return`${t(Math.abs(i[r]))} of ${t(e[r])} N along ${"xyz"[r]}`}function yC(){let i=new $s(Cp,Rp,al,Tu,Pp),e=[...i.index.array],t=Array.from({length:al*Tu},(n,s)=>s%al*Tu+Math.floor(s/al));return i.setIndex(t.flatMap(n=>e.slice(6*n,6*n+6))),i}var Lp=class{group=new At;tip=new U;tube;head;constructor(e){let t=new On({color:e,emissive:e,emissiveIntensity:.35});this.tube=new ct(yC(),t),this.head=new ct(new Rs(2.8*Rp,8*Rp,12),t),this.group.add(this.tube,this.head)}show(e,t){let n=t.length();if(this.group.visible=n>Xx,!this.group.visible)return;let s=Math.min(Math.max(vC*n,xC),Pp);this.tube.geometry.setDrawRange(0,6*al*Math.round(Tu*s/Pp)),this.head.position.set(Cp*Math.cos(s),Cp*Math.sin(s),0),this.head.rotation.z=s,this.group.position.copy(e),this.group.quaternion.setFromUnitVectors(qx,t.clone().divideScalar(n)),this.group.updateMatrixWorld(),this.tip.copy(this.head.position).applyMatrix4(this.group.matrixWorld)}},Eu=class{group=new At;arrow=new ir(pt.push,.02,Wx,Xx);moment=new Lp(pt.moment);hoop;constructor(){let e=new ln({color:pt.hand,transparent:!0});this.hoop=new ct(new $s(.075,.008,4,20),e),this.group.add(this.arrow.group,this.moment.group,this.hoop)}show(e,t,n,s){this.arrow.show(e,t),this.moment.show(e,n);let r=s?Ip(t,s):0;if(this.hoop.visible=this.arrow.visible&&r>0&&r<1/0,!this.hoop.visible)return;let o=new U(...t).normalize();this.hoop.position.copy(e).addScaledVector(o,Wx*r),this.hoop.quaternion.setFromUnitVectors(qx,o),this.hoop.material.opacity=Zt(t)>r?.5:1}};function _C(i,e,t){return t*Math.sqrt(Math.max(i,0)/e)/Math.PI}var Au=class{constructor(e,t){this.audio=t;this.all=new GainNode(t,{gain:0});let n=new BiquadFilterNode(t,{type:"lowpass",frequency:1800});this.all.connect(n).connect(t.destination);let s=t.createPeriodicWave([0,0,0,0,0,0],[0,1,.55,.3,.2,.1]),{quadrotors:r}=e.vehicle,o=Math.max(...r.map(({position:h})=>Math.abs(h[1])),.1),a=r.flatMap(h=>h.rotors),l=Math.ceil(a.length/16),c=a.map((h,u)=>({...h,i:u})).filter(({i:h})=>h%l===0);this.voices=c.map(({position:h,max_thrust:u,max_speed:d,i:f})=>{let m=new OscillatorNode(t,{type:"custom",periodicWave:s,frequency:1}),_=new GainNode(t,{gain:0}),g=new StereoPannerNode(t,{pan:Math.max(-.7,Math.min(.7,-.7*h[1]/o))});return m.connect(_).connect(g).connect(this.all),m.start(),{rotor:f,most:u,fastest:d,tone:m,loud:_}})}audio;all;voices;time=NaN;heard=0;update(e,t){let n=this.audio.currentTime;t!==this.time&&(this.heard=n),this.time=t,this.all.gain.setTargetAtTime(n-this.heard>.25?0:.14,n,.03);for(let{rotor:s,most:r,fastest:o,tone:a,loud:l}of this.voices){let c=e[s]??0;a.frequency.setTargetAtTime(_C(c,r,o),n,.03),l.gain.setTargetAtTime(Math.max(c/r,0)/Math.sqrt(this.voices.length),n,.03)}}silence(){this.all.gain.setTargetAtTime(0,this.audio.currentTime,.03)}stop(){for(let{tone:e}of this.voices)e.stop();this.all.disconnect()}};var bC=.5,SC=500,MC=20,[wC,TC]=[60,15],EC=.12,Cu=class{constructor(e){this.on=e;window.addEventListener("pointerdown",()=>{this.context?.resume()}),document.addEventListener("visibilitychange",()=>{document.hidden?this.context?.suspend():this.context?.resume()})}on;context=null;sound=null;scene=null;touched=-1/0;passed=!1;begin(e){this.scene=e,this.sound?.stop(),this.sound=null}update(e,t,n){this.hum(e);let[s,r]=e.vector("contact_force"),o=Math.hypot(s,r);o>bC&&(n-this.touched>SC&&this.touch(o),this.touched=n);let a=e.vector("push"),l=Zt(a)>Ip(a,t);l&&!this.passed&&this.on.vibration&&navigator.vibrate(TC),this.passed=l}hum(e){this.on.rotors?this.scene&&(this.sound??=new Au(this.scene,this.audio),this.sound.update(e.list("thrusts"),e.scalar("time"))):this.sound?.silence()}touch(e){this.on.vibration&&navigator.vibrate(wC),this.on.touches&&AC(this.audio,Math.min(e/MC,1))}get audio(){return this.context??=new AudioContext,this.context}};function AC(i,e){let t=i.createBuffer(1,Math.ceil(EC*i.sampleRate),i.sampleRate),n=t.getChannelData(0);n.forEach((o,a)=>n[a]=(2*Math.random()-1)*Math.exp(-6*a/n.length));let s=new AudioBufferSourceNode(i,{buffer:t}),r=new BiquadFilterNode(i,{type:"lowpass",frequency:300+900*e});s.connect(r).connect(new GainNode(i,{gain:.25+.6*e})).connect(i.destination),s.start()}var $x="tandemlift.show",Zx=[["push","push and moment",!0],["zone","threshold",!0],["ghost","reference",!0],["thrust","thrusts",!0],["wind","wind",!0],["trail","path flown",!0],["trails","paths stay",!1],["person","person, 1.75 m",!1]],Np=[["rotors","sound of the rotors",!1],["touches","sound of touches",!1],["vibration","vibration",!1]];function Kx(){let i=Object.fromEntries([...Zx,...Np].map(([t,,n])=>[t,n])),e=Object.entries(bh($x)??{}).filter(([t,n])=>t in i&&typeof n=="boolean");return{...i,...Object.fromEntries(e)}}var Ru=class{button=X("button",{type:"button","aria-expanded":"false","aria-controls":"show"});follow;menu=Ke("show");constructor(e,t){let n=r=>r.map(([o,a])=>Ga(a,e[o],l=>{e[o]=l,Mo($x,JSON.stringify(e))})),s="vibrate"in navigator?Np:Np.filter(([r])=>r!=="vibration");this.follow=Ga("camera follows (F)",!0,t),this.menu.replaceChildren(...n(Zx),X("hr"),...n(s),X("hr"),this.follow),this.button.append(Gi("eye"),X("span",{},"Show")),this.button.addEventListener("click",()=>this.open(this.menu.hidden!==!1)),window.addEventListener("pointerdown",({target:r})=>{r instanceof Node&&!this.menu.contains(r)&&!this.button.contains(r)&&this.open(!1)}),window.addEventListener("keydown",({key:r})=>{r!=="Escape"||this.menu.hidden!==!1||(this.open(!1),this.button.focus())})}open(e){this.menu.hidden=!e,this.button.setAttribute("aria-expanded",String(e)),e&&this.menu.querySelector("input").focus()}};var CC={you:"you",other:"another page",none:"nobody"},Jx="Of what the rotors counter in hover: the largest part, of force across, up, down and of the moment about an axis",RC=.97;function PC(i,[e,t,n,...s]){let[r,o,a]=i.vector("push"),l=i.vector("push_moment").map((c,h)=>Math.abs(c)/s[h]);return Math.max(Math.hypot(r,o)/e,a/(a>0?t:-n),...l)}var Pu=class{values=new Map;badge=Ke("mode");share=X("meter",{max:1,low:.5,high:.85,optimum:0,title:Jx});authority;taken=0;constructor(e,t){let r=[...e?["time"]:["time","hand takes","speed","latency",...t?[]:["held by","viewers"],"recorded"],"frame rate"].map(o=>{let a=X("dd",{},"\u2013");return this.values.set(o,a),X("div",{class:o.replace(" ","-")},X("dt",{},o),a)});Ke("meters").replaceChildren(...r),this.values.get("hand takes")?.parentElement.append(this.share)}scene({mission:e,controller:t,engine:n,version:s,authority:r}){this.authority=r,this.share.parentElement?.toggleAttribute("hidden",!r),Ke("mission").textContent=e,Ke("controller").textContent=t,Ke("mission").title=`engine ${n}, version ${s}`,document.title=`${e} \xB7 tandemlift`}status(e){let{text:t,kind:n}=b0(e);this.badge.textContent=e.paused?`paused \xB7 ${t}`:t,this.badge.className=`badge ${n}`;let{factor:s}=e,r=!e.paused&&!e.preparing&&s<RC*e.speed;this.set("speed",`\xD7${s.toFixed(2)}`,r?`late by ${e.behind_ms.toFixed(0)} ms`:""),this.set("held by",CC[e.holder]),this.set("viewers",String(e.viewers)),this.set("recorded",`${e.recorded_s.toFixed(0)} s`)}frame(e){this.authority&&(this.taken=Math.max(this.taken,PC(e,this.authority)))}update(e,t,n){e&&this.set("time",`${e.scalar("time").toFixed(1)} s`),this.authority&&this.set("hand takes",`${(100*this.taken).toFixed(0)} %`,this.taken>1?Jx:""),[this.share.value,this.taken]=[this.taken,0],this.set("latency",t===null?"\u2013":`${t.toFixed(0)} ms`),this.set("frame rate",n===null?"at rest":`${n.toFixed(0)}/s`)}disconnected(){this.badge.textContent="no connection",this.badge.className="badge off"}set(e,t,n=""){let s=this.values.get(e);s&&(s.textContent!==t&&(s.textContent=t),s.title=n,s.classList.toggle("late",n!==""))}};var LC=50,Lu=class{constructor(e){this.send=e;this.buttons=[Tt("back","Undo","Take the last change of a setting back (Ctrl+Z)",()=>this.undo()),Tt("again","Redo","Make it again (Ctrl+Shift+Z)",()=>this.redo())],this.element=X("div",{class:"undo"},...this.buttons),this.show()}send;element;values=new Map;awaited=new Map;done=[];undone=[];last=-1/0;buttons;scene(e){let t=e.filter(({key:n,value:s})=>(this.values.get(n)??"")!==JSON.stringify(s));for(let{key:n,value:s}of e)this.values.set(n,JSON.stringify(s));t.length&&([this.done,this.undone]=[[],[]]),this.awaited.clear(),this.show()}changed(e,t,n){let[s,r]=[this.values.get(e),JSON.stringify(t)];if(this.values.set(e,r),this.awaited.get(e)===r){this.awaited.delete(e);return}if(s===void 0||s===r)return;let o={key:e,before:JSON.parse(s),after:t};n-this.last<LC?this.done.at(-1)?.push(o):this.done.push([o]),[this.last,this.undone]=[n,[]],this.show()}undo(){[...this.done.at(-1)??[]].reverse().every(({key:t,before:n})=>this.set(t,n))&&this.undone.push(...this.done.splice(-1)),this.show()}redo(){(this.undone.at(-1)??[]).every(({key:t,after:n})=>this.set(t,n))&&this.done.push(...this.undone.splice(-1)),this.show()}key({ctrlKey:e,metaKey:t,shiftKey:n,key:s,target:r}){let o=r instanceof HTMLInputElement&&r.value!==r.defaultValue&&r.type!=="range",a=s.toLowerCase();return!(e||t)||o||!["z","y"].includes(a)||document.querySelector("dialog[open]")?!1:(n||a==="y"?this.redo():this.undo(),!0)}set(e,t){return this.last=-1/0,this.awaited.set(e,JSON.stringify(t)),this.send({type:"set",key:e,value:t})!==null?!0:(this.awaited.delete(e),!1)}show(){this.buttons[0].disabled=this.done.length===0,this.buttons[1].disabled=this.undone.length===0}};var IC=["video/webm;codecs=vp9","video/webm;codecs=vp8","video/webm","video/mp4"];var Iu=class{recorder=null;get running(){return this.recorder!==null}start(e,t){let n="MediaRecorder"in window?IC.find(r=>MediaRecorder.isTypeSupported(r)):void 0;if(!n)return"this browser cannot record a video";let s=[];return this.recorder=new MediaRecorder(e.captureStream(30),{mimeType:n,videoBitsPerSecond:6e6}),this.recorder.ondataavailable=({data:r})=>s.push(r),this.recorder.onstop=()=>{let r=n.includes("mp4")?"mp4":"webm";NC(new Blob(s,{type:n}),`${t}.${r}`)},this.recorder.start(1e3),""}stop(){this.recorder?.stop(),this.recorder=null}};function NC(i,e){let t=document.createElement("a");t.href=URL.createObjectURL(i),t.download=e,t.click(),window.setTimeout(()=>URL.revokeObjectURL(t.href),6e4)}var DC=200,jx={behind:"behind",side:"side",above:"above",board:"on board"},FC=900,OC=450,Nu=class{constructor(e){this.page=e;this.notices=new vu(()=>e.retry()),this.findings=new Nh(this.notices);let t=(n,s)=>this.lecture.load(n,s);this.missions=new gu(e.send.bind(e),this.notices,this.question,t),this.lecture=new mu(e,{look:n=>this.views()[Object.keys(jx).indexOf(n)].click(),choose:()=>this.missions.choose(),tell:(n,s)=>this.question.tell(n,s)}),this.bar=new Pu(e.replay!==null,e.companions!==void 0),this.undo=new Lu(e.send.bind(e)),this.comparison=new Eh(e.compare),this.panel=new bu(Ke("panel"),e,this.undo.element),this.laboratory=new au(e,n=>this.notices.show(n,"done")),this.help=E0(e.replay!==null),this.saving=new wu(n=>e.send({type:"save",name:n})),Ke("show-help").addEventListener("click",()=>this.openHelp()),If("show-panel","panel",window.innerWidth>=FC&&e.replay===null),If("show-plots","plots",window.innerHeight>=OC&&window.parent===window),this.senses=new Cu(e.shown),this.show=new Ru(e.shown,n=>e.camera.following=n),this.makeViews(),this.challenge=new Mh(n=>this.saving.open(n),()=>e.send({type:"reset"}),n=>this.panel.challenged(n)),e.replay||this.makeDock(),this.ended=new Ih(()=>e.send({type:"reset"})),window.addEventListener("keydown",this.key)}page;notices;bar;panel;help;saving;ended;missions;findings;video=new Iu;laboratory;challenge;comparison;lecture;senses;show;undo;dock=null;player=null;question=new Su;mission="flight";floor=0;pulled=!1;texts=0;get recording(){return this.video.running}endVideo(){this.recording&&this.toggleVideo()}scene(e){if([this.mission,this.floor]=[e.mission,e.floor],this.bar.scene(e),this.panel.scene(e),this.laboratory.show(e),this.undo.scene(e.parameters),this.missions.scene(e),this.senses.begin(e),this.challenge.begin(e),this.comparison.begin(this.page.companions),this.tellSettings(e),this.lecture.begun(),this.dock?.reset(this.missions.open),!this.page.replay||!e.replay)return;let{element:t}=this.laboratory.timeline;this.player=new Mu(Ke("dock"),e.replay,this.page.replay,t,()=>this.toggleVideo())}frame(e){this.laboratory.frame(e),this.bar.frame(e),this.challenge.frame(e),this.lecture.frame(e),e.scalar("held")>0&&(this.pulled=!0)}status(e){this.bar.status(e),this.challenge.status(e),this.comparison.status(e),this.dock?.status(e),this.page.replay||this.ended.status(e),this.lecture.status(e),this.panel.markFailed(e.failed_rotors),this.hint(e),this.findings.status(e.findings??[]),this.laboratory.status(e)}changed(e,t,n){this.panel.changed(e,t,n),this.laboratory.changed(e,t),this.challenge.changed(e,t),this.tellSettings({...this.lecture.scene,parameters:_h(this.lecture.scene.parameters,e,t)}),this.undo.changed(e,t,performance.now())}refused(e,t){if(e==="save"&&this.saving.refused(t))return;if(e==="fly"){this.missions.refused(t);return}if(["ask","enable"].includes(e)&&this.dock){this.dock.refused(t);return}(!this.panel.refused(e,t)||Ke("panel").hidden)&&this.notices.show(`${e}: ${t}`,"refused")}done(e,t){if(e==="fly"){this.missions.done(t);return}e==="save"&&this.saving.done(),this.notices.show(e==="save"?`Saved as ${t}`:`${e}: ${t}`,"done")}explain(e){this.notices.explain(e)}connected(){this.notices.connected()}disconnected(e){this.notices.disconnected(e),this.bar.disconnected(),this.saving.refused("The connection is lost: the flight was not saved.")}tick(e){let{page:t}=this;this.laboratory.tick(e),this.lecture.tick(e);let{threshold:n}=this.laboratory;t.current&&n&&this.senses.update(t.current,n,e),t.current&&this.player?.update(t.current.scalar("time")),!(e-this.texts<DC)&&(this.texts=e,this.challenge.tick(),this.bar.update(t.current,t.latency.median,t.frameRate.rate),t.current&&this.panel.showThrusts(t.current.list("thrusts")))}makeDock(){let{page:e}=this;this.dock=new Lh(Ke("dock"),e.send.bind(e),this.question,{height:()=>e.current?e.current.vector("position")[2]-this.floor:null,open:()=>this.missions.choose(),save:()=>this.saving.open(Wa(this.mission)),film:()=>this.toggleVideo()}),this.undo.element.append(this.comparison.menu),Ke("dock").prepend(this.comparison.element,this.challenge.element),Ke("dock").lastElementChild.append(this.challenge.button)}tellSettings(e){this.comparison.show(e),this.lecture.scene=e}views(){return[...Ke("views").querySelectorAll(".choice button")]}makeViews(){let{page:e}=this,t=Ri("View",jx,"behind",n=>e.look(n));Ke("views").replaceChildren(t,this.show.button,...e.replay?[]:R0(e.hand)),Ke("show").append(this.lecture.button)}openHelp(){this.help.showModal(),this.help.scrollTop=0}toggleVideo(){let e="";this.video.running?this.video.stop():e=this.video.start(this.page.canvas,Wa(this.mission)),e&&this.notices.show(e,"refused"),this.dock?.filming(this.video.running),Ke("dock").classList.toggle("filming",this.video.running)}hint(e){let t=Ke("hint"),n=P0(e,this.pulled);t.textContent!==n&&(t.textContent=n),t.hidden=n===""||this.page.replay!==null}key=e=>{this.undo.key(e)&&e.preventDefault(),!(Va(e)||e.ctrlKey||e.metaKey||e.altKey)&&(e.repeat&&!e.code.startsWith("Arrow")||this.keys().get(e.code)?.())};keys(){let{player:e}=this,t=new Map(this.views().map((n,s)=>[`Digit${s+1}`,()=>n.click()]));return t.set("KeyF",()=>this.show.follow.click()),t.set("KeyT",()=>this.lecture.toggle()),e?(t.set("KeyP",()=>e.toggle()),t.set("ArrowLeft",()=>e.step(-1)),t.set("ArrowRight",()=>e.step(1))):(t.set("KeyP",()=>this.dock?.togglePause()),t.set("KeyR",()=>this.laboratory.rewind()),t.set("KeyL",()=>this.dock?.ask("lift")),t.set("KeyK",()=>this.dock?.ask("land"))),t}};var Qx="tandemlift.colours";function UC(i){return i==="light"||i==="dark"?i:"auto"}function kC(i,e){return i!=="auto"?i:e?"dark":"light"}var Du=class{constructor(e){this.changed=e;this.system.addEventListener("change",this.apply),this.apply()}changed;system=window.matchMedia("(prefers-color-scheme: dark)");chosen=UC(Df(Qx));get choice(){return this.chosen}choose(e){this.chosen=e,Mo(Qx,e),this.apply()}apply=()=>{let e=kC(this.chosen,this.system.matches);document.documentElement.dataset.theme=e,this.changed(e)}};var ey={type:"change"},Fp={type:"start"},ny={type:"end"},Fu=new gr,ty=new di,BC=Math.cos(70*lh.DEG2RAD),Tn=new U,ri=2*Math.PI,Lt={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},Dp=1e-6,Ou=class extends Ca{constructor(e,t=null){super(e,t),this.state=Lt.NONE,this.target=new U,this.cursor=new U,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:js.ROTATE,MIDDLE:js.DOLLY,RIGHT:js.PAN},this.touches={ONE:Qs.ROTATE,TWO:Qs.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle="auto",this._domElementKeyEvents=null,this._lastPosition=new U,this._lastQuaternion=new Dn,this._lastTargetPosition=new U,this._quat=new Dn().setFromUnitVectors(e.up,new U(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new mo,this._sphericalDelta=new mo,this._scale=1,this._panOffset=new U,this._rotateStart=new He,this._rotateEnd=new He,this._rotateDelta=new He,this._panStart=new He,this._panEnd=new He,this._panDelta=new He,this._dollyStart=new He,this._dollyEnd=new He,this._dollyDelta=new He,this._dollyDirection=new U,this._mouse=new He,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=VC.bind(this),this._onPointerDown=zC.bind(this),this._onPointerUp=GC.bind(this),this._onContextMenu=ZC.bind(this),this._onMouseWheel=XC.bind(this),this._onKeyDown=qC.bind(this),this._onTouchStart=YC.bind(this),this._onTouchMove=$C.bind(this),this._onMouseDown=HC.bind(this),this._onMouseMove=WC.bind(this),this._interceptControlDown=KC.bind(this),this._interceptControlUp=JC.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this._cursorStyle=e,e==="grab"?this.domElement.style.cursor="grab":this.domElement.style.cursor="auto"}get cursorStyle(){return this._cursorStyle}connect(e){super.connect(e),this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.state=Lt.NONE,this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction="",this.domElement.style.cursor="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(ey),this.update(),this.state=Lt.NONE}pan(e,t){this._pan(e,t),this.update()}dollyIn(e){this._dollyIn(e),this.update()}dollyOut(e){this._dollyOut(e),this.update()}rotateLeft(e){this._rotateLeft(e),this.update()}rotateUp(e){this._rotateUp(e),this.update()}update(e=null){let t=this.object.position;Tn.copy(t).sub(this.target),Tn.applyQuaternion(this._quat),this._spherical.setFromVector3(Tn),this.autoRotate&&this.state===Lt.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(n)&&isFinite(s)&&(n<-Math.PI?n+=ri:n>Math.PI&&(n-=ri),s<-Math.PI?s+=ri:s>Math.PI&&(s-=ri),n<=s?this._spherical.theta=Math.max(n,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+s)/2?Math.max(n,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let o=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),r=o!=this._spherical.radius}if(Tn.setFromSpherical(this._spherical),Tn.applyQuaternion(this._quatInverse),t.copy(this.target).add(Tn),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let o=null;if(this.object.isPerspectiveCamera){let a=Tn.length();o=this._clampDistance(a*this._scale);let l=a-o;this.object.position.addScaledVector(this._dollyDirection,l),this.object.updateMatrixWorld(),r=!!l}else if(this.object.isOrthographicCamera){let a=new U(this._mouse.x,this._mouse.y,0);a.unproject(this.object);let l=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),r=l!==this.object.zoom;let c=new U(this._mouse.x,this._mouse.y,0);c.unproject(this.object),this.object.position.sub(c).add(a),this.object.updateMatrixWorld(),o=Tn.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;o!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(o).add(this.object.position):(Fu.origin.copy(this.object.position),Fu.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(Fu.direction))<BC?this.object.lookAt(this.target):(ty.setFromNormalAndCoplanarPoint(this.object.up,this.target),Fu.intersectPlane(ty,this.target))))}else if(this.object.isOrthographicCamera){let o=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),o!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._scale=1,this._performCursorZoom=!1,r||this._lastPosition.distanceToSquared(this.object.position)>Dp||8*(1-this._lastQuaternion.dot(this.object.quaternion))>Dp||this._lastTargetPosition.distanceToSquared(this.target)>Dp?(this.dispatchEvent(ey),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e!==null?ri/60*this.autoRotateSpeed*e:ri/60/60*this.autoRotateSpeed}_getZoomScale(e){let t=Math.abs(e*.01);return Math.pow(.95,this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){Tn.setFromMatrixColumn(t,0),Tn.multiplyScalar(-e),this._panOffset.add(Tn)}_panUp(e,t){this.screenSpacePanning===!0?Tn.setFromMatrixColumn(t,1):(Tn.setFromMatrixColumn(t,0),Tn.crossVectors(this.object.up,Tn)),Tn.multiplyScalar(e),this._panOffset.add(Tn)}_pan(e,t){let n=this.domElement;if(this.object.isPerspectiveCamera){let s=this.object.position;Tn.copy(s).sub(this.target);let r=Tn.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*r/n.clientHeight,this.object.matrix),this._panUp(2*t*r/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let n=this.domElement.getBoundingClientRect(),s=e-n.left,r=t-n.top,o=n.width,a=n.height;this._mouse.x=s/o*2-1,this._mouse.y=-(r/a)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientY),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(ri*this._rotateDelta.x/t.clientHeight),this._rotateUp(ri*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(ri*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(-ri*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(ri*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(-ri*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),t=!0;break}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._rotateStart.set(n,s)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panStart.set(n,s)}}_handleTouchStartDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(n*n+s*s);this._dollyStart.set(0,r)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{let n=this._getSecondPointerPosition(e),s=.5*(e.pageX+n.x),r=.5*(e.pageY+n.y);this._rotateEnd.set(s,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(ri*this._rotateDelta.x/t.clientHeight),this._rotateUp(ri*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panEnd.set(n,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(n*n+s*s);this._dollyEnd.set(0,r),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let o=(e.pageX+t.x)*.5,a=(e.pageY+t.y)*.5;this._updateZoomParameters(o,a)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new He,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){let t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){let t=e.deltaMode,n={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100;break}return e.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}};function zC(i){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(i.pointerId),this.domElement.ownerDocument.addEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(i)&&(this._addPointer(i),i.pointerType==="touch"?this._onTouchStart(i):this._onMouseDown(i),this._cursorStyle==="grab"&&(this.domElement.style.cursor="grabbing")))}function VC(i){this.enabled!==!1&&(i.pointerType==="touch"?this._onTouchMove(i):this._onMouseMove(i))}function GC(i){switch(this._removePointer(i),this._pointers.length){case 0:this.domElement.releasePointerCapture(i.pointerId),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(ny),this.state=Lt.NONE,this._cursorStyle==="grab"&&(this.domElement.style.cursor="grab");break;case 1:let e=this._pointers[0],t=this._pointerPositions[e];this._onTouchStart({pointerId:e,pageX:t.x,pageY:t.y});break}}function HC(i){let e;switch(i.button){case 0:e=this.mouseButtons.LEFT;break;case 1:e=this.mouseButtons.MIDDLE;break;case 2:e=this.mouseButtons.RIGHT;break;default:e=-1}switch(e){case js.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(i),this.state=Lt.DOLLY;break;case js.ROTATE:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=Lt.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=Lt.ROTATE}break;case js.PAN:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=Lt.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=Lt.PAN}break;default:this.state=Lt.NONE}this.state!==Lt.NONE&&this.dispatchEvent(Fp)}function WC(i){switch(this.state){case Lt.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(i);break;case Lt.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(i);break;case Lt.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(i);break}}function XC(i){this.enabled===!1||this.enableZoom===!1||this.state!==Lt.NONE||(i.preventDefault(),this.dispatchEvent(Fp),this._handleMouseWheel(this._customWheelEvent(i)),this.dispatchEvent(ny))}function qC(i){this.enabled!==!1&&this._handleKeyDown(i)}function YC(i){switch(this._trackPointer(i),this._pointers.length){case 1:switch(this.touches.ONE){case Qs.ROTATE:if(this.enableRotate===!1){this.state=Lt.NONE;break}this._handleTouchStartRotate(i),this.state=Lt.TOUCH_ROTATE;break;case Qs.PAN:if(this.enablePan===!1){this.state=Lt.NONE;break}this._handleTouchStartPan(i),this.state=Lt.TOUCH_PAN;break;default:this.state=Lt.NONE}break;case 2:switch(this.touches.TWO){case Qs.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(i),this.state=Lt.TOUCH_DOLLY_PAN;break;case Qs.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(i),this.state=Lt.TOUCH_DOLLY_ROTATE;break;default:this.state=Lt.NONE}break;default:this.state=Lt.NONE}this.state!==Lt.NONE&&this.dispatchEvent(Fp)}function $C(i){switch(this._trackPointer(i),this.state){case Lt.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(i),this.update();break;case Lt.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(i),this.update();break;case Lt.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(i),this.update();break;case Lt.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(i),this.update();break;default:this.state=Lt.NONE}}function ZC(i){this.enabled!==!1&&i.preventDefault()}function KC(i){i.key==="Control"&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function JC(i){i.key==="Control"&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}var jC={behind:[-2.25,-1.1,1.15],side:[.2,-3.1,.75],above:[-.02,0,4]},QC=2.4,eR=.16,tR=6,nR=42,iR=66,sR=new U(-.62,0,.36),rR=3,Uu=class{constructor(e,t){this.camera=e;this.orbit=new Ou(e,t),this.orbit.minDistance=.8,this.orbit.maxDistance=80,this.orbit.maxPolarAngle=.53*Math.PI,this.orbit.zoomSpeed=.8}camera;orbit;following=!0;vehicle=new U;fitted=1;seat=null;look(e,t,n,s=!1){this.leave(),this.vehicle.copy(t),this.fitted=this.fit,this.orbit.target.copy(t);let r=n*this.fitted*(s&&e==="above"?QC:1);this.camera.position.copy(t).addScaledVector(new U(...jC[e]),r),this.orbit.update()}board(e){this.leave(iR);let t=new U(...e).add(sR),n=new dt().lookAt(t,new U(rR,.3*e[1],e[2]-.3),this.camera.up);this.seat={eye:t,turn:new Dn().setFromRotationMatrix(n)},this.orbit.enabled=!1}leave(e=nR){this.seat=null,this.orbit.enabled=!0,this.camera.fov=e,this.camera.updateProjectionMatrix()}get fit(){return Math.max(1,1.35/Math.max(this.camera.aspect,.4))}refit(){let{target:e}=this.orbit;this.camera.position.sub(e).multiplyScalar(this.fit/this.fitted).add(e),this.fitted=this.fit}update(e,t,n){let s=e.position;if(this.seat){this.camera.position.copy(e.localToWorld(this.seat.eye.clone())),this.camera.quaternion.copy(e.quaternion).multiply(this.seat.turn);return}this.fit!==this.fitted&&this.refit();let r=s.distanceTo(this.vehicle)>2,o=s.clone().sub(this.vehicle);this.vehicle.copy(s),this.following&&r?this.move(o):this.following&&this.move(this.pursuit(s,t,n)),this.orbit.update()}pursuit(e,t,n){let s=e.clone().sub(this.orbit.target),r=t?eR*this.camera.position.distanceTo(this.orbit.target):0,o=Math.max(s.length()-r,0);return s.setLength(o*(1-Math.exp(-tR*n)))}move(e){this.orbit.target.add(e),this.camera.position.add(e)}};function Op(){let i=document.createElement("canvas").getContext("webgl2");if(!i)return"light";let e=i.getExtension("WEBGL_debug_renderer_info"),t=e?i.getParameter(e.UNMASKED_RENDERER_WEBGL):"";return i.getExtension("WEBGL_lose_context")?.loseContext(),/swiftshader|llvmpipe|software|softpipe|basic render/i.test(String(t))?"light":"full"}var ku=class{rate=0;drawn=0;count=0;busy=!1;since=0;slow=0;tick(e,t,n){this.count+=1,t&&(this.drawn+=1),this.busy||=!n;let s=(e-this.since)/1e3;return s<1?!1:(s<2&&(this.rate=this.busy?this.drawn/s:null,this.slow=this.count/s<25&&!n?this.slow+s:0),this.since=e,this.count=this.drawn=0,this.busy=!1,this.slow>=3)}};var iy=["push","moment","wind","contact","ending","refusal"];function sy(i){let e=[];for(let t of iy)e.push(new Up(i,t,[...e]));return Object.fromEntries(iy.map((t,n)=>[t,e[n]]))}var Up=class{constructor(e,t,n){this.before=n;this.element=document.createElement("div"),this.element.className=`label ${t}`,this.element.hidden=!0,e.append(this.element),new ResizeObserver(()=>[this.width,this.height]=[e.clientWidth,e.clientHeight]).observe(e)}before;element;text="";width=0;height=0;own=[0,0,0,0];at=[0,0];hide(){this.element.hidden||(this.element.hidden=!0)}show(e,t,n){let s=t.clone().project(n);if(Math.abs(s.z)>1){this.hide();return}if(this.element.hidden&&(this.element.hidden=!1),e!==this.text){let{element:u}=this;u.textContent=this.text=e,this.own=[u.offsetLeft,u.offsetTop,u.offsetWidth,u.offsetHeight]}let[r,o,a,l]=this.own,c=Math.min((s.x/2+.5)*this.width,this.width-a-12),h=Math.min((.5-s.y/2)*this.height,this.height-l-12);this.at=[Math.max(c,-12)+r,h+o];for(let u=this.covered();u;u=this.covered())this.at[1]=u.at[1]+u.own[3];this.element.style.transform=`translate(${(this.at[0]-r).toFixed(1)}px, ${(this.at[1]-o).toFixed(1)}px)`}covered(){let e=(t,n)=>this.at[n]<t.at[n]+t.own[n+2]&&t.at[n]<this.at[n]+this.own[n+2];return this.before.find(t=>!t.element.hidden&&e(t,0)&&e(t,1))}};var ry=14,oR=.035,Bu=class{group=new At;point;end;spring;zone=new At;places=new Float32Array(3*(2*ry+2));constructor(){let e=new ln({color:pt.hand,depthTest:!1,transparent:!0,opacity:.9});this.point=new ct(new Jn(.03,14,10),e),this.end=new ct(new Jn(.022,12,8),e);let t=new zt().setAttribute("position",new Qt(this.places,3));this.spring=new rs(t,new pi({color:pt.hand,depthTest:!1,transparent:!0})),this.spring.frustumCulled=!1,this.zone.add(...aR()),this.group.add(this.point,this.end,this.spring,this.zone);for(let n of this.group.children)n.renderOrder=8;this.hide()}hide(){this.group.visible=!1}offer(e){this.group.visible=!0,this.end.visible=this.spring.visible=this.zone.visible=!1,this.point.position.copy(e),this.point.scale.setScalar(1.8)}show(e,t,n){this.group.visible=this.end.visible=this.spring.visible=!0,this.point.position.copy(e),this.point.scale.setScalar(1),this.end.position.copy(t),this.zone.visible=n!==null,n&&(this.zone.position.copy(e),this.zone.scale.copy(n).multiplyScalar(2)),this.coil(e,t)}coil(e,t){let n=t.clone().sub(e),s=new U(0,0,1).cross(n);s.lengthSq()<1e-9&&s.set(1,0,0),s.setLength(Math.min(oR,.3*n.length()));let r=2*ry+1;for(let o=0;o<=r;o++){let a=o<2||o>r-2?0:o%2?1:-1;e.clone().addScaledVector(n,o/r).addScaledVector(s,a).toArray(this.places,3*o)}this.spring.geometry.attributes.position.needsUpdate=!0}};function aR(){let i=new ti(1,1,1),e=new ln({color:pt.hand,transparent:!0,opacity:.16,depthTest:!1}),t=new pi({color:pt.hand,transparent:!0,opacity:.8,depthTest:!1});return[new ct(i,e),new os(new vr(i),t)]}var lR=1.75,[oy,cR]=[1,1.4],ay=[.001,0,.15,0,.165,.1,.135,.28,.17,.5,.19,.57,.12,.64,.05,.66,.05,.72],zu=class{constructor(e,t,n){this.floor=e;this.reach=t;this.mesh=new ct(hR(n==="full"?20:8),new On({color:pt.person})),this.mesh.castShadow=n==="full",this.mesh.visible=!1}floor;reach;mesh;placed=!1;accompany(e){let{position:t}=this.mesh;this.placed||t.set(e.x+oy,e.y+.3*this.reach,this.floor),this.placed=!0;let n=new U(e.x-t.x,e.y-t.y,0),s=n.length(),r=Math.min(Math.max(s,oy),cR);s>0&&t.addScaledVector(n,1-r/s),this.mesh.rotation.z=Math.atan2(n.y,n.x)}};function hR(i){let e=ay.flatMap((o,a)=>a%2?[]:[new He(o,ay[a+1])]),t=(o,a,l)=>new Ei(o,a,l,i),n=[-1,1].flatMap(o=>[t(.085,.05,.86).translate(0,.43,.095*o),t(.05,.038,.66).rotateX(-.12*o).translate(0,1.1,.235*o),new Jn(.06,i,i).scale(2.1,.7,.85).translate(.06,.04,.095*o)]),s=new _a(e,i).scale(.68,1,1).translate(0,.83,0),r=new Jn(.1,i,i).scale(.95,1.2,.82).translate(.015,lR-.12,0);return Ao([s,r,...n]).rotateX(Math.PI/2)}var Vo=new U(.35,-.42,.84).normalize(),Vu=class{mesh;press;constructor(e,t){this.mesh=new ct(e,new ln({color:pt.shade})),this.mesh.matrixAutoUpdate=!1,this.mesh.frustumCulled=!1;let[n,s]=[Vo.x/Vo.z,Vo.y/Vo.z],r=.001,o=t+.002;this.press=new dt().set(1,0,-n,n*t,0,1,-s,s*t,0,0,r,o-r*t,0,0,0,1)}place(e){e.updateMatrixWorld(),this.mesh.matrix.multiplyMatrices(this.press,e.matrixWorld)}};var ly=225,uR=.08,dR=200,fR=.4,Gu=class{line;count=0;places=new Float32Array(3*ly);constructor(){let e=new zt().setAttribute("position",new Qt(this.places,3));this.line=new rs(e,new pi({color:pt.path,transparent:!0,opacity:.75})),this.line.frustumCulled=!1,this.clear()}get full(){return this.count===ly}get end(){return[...this.places.subarray(3*(this.count-1),3*this.count)]}clear(){this.count=0,this.line.geometry.setDrawRange(0,0)}add(e){let t=this.places.subarray(3*(this.count-2),3*(this.count-2)+3),n=this.count<2||Math.hypot(e[0]-t[0],e[1]-t[1],e[2]-t[2])>uR;n&&this.full?this.places.copyWithin(0,3):n&&(this.count+=1),this.places.set(e,3*(this.count-1)),this.line.geometry.attributes.position.needsUpdate=!0,this.line.geometry.setDrawRange(0,this.count)}remove(){this.line.removeFromParent(),this.line.geometry.dispose(),this.line.material.dispose()}},Hu=class{group=new At;stay=!1;now=new Gu;past=[];constructor(){this.group.add(this.now.line)}begin(){this.stay&&this.now.count>1&&this.setAside(),this.now.clear();for(let{line:e}of[...this.past,this.now])e.material.color.set(pt.path);for(let{line:e}of this.past)e.material.opacity=fR;this.prune()}add(e){if(this.stay&&this.now.full){let{end:t}=this.now;this.setAside(),this.now.add(t)}this.now.add(e),this.prune()}setAside(){this.past.push(this.now),this.now=new Gu,this.group.add(this.now.line)}prune(){let e=this.stay?dR:0;for(;this.past.length>e;)this.past.shift().remove()}},Wu=class{constructor(e){this.floor=e;let t=new zt().setAttribute("position",new Qt(this.ends,3));this.line=new os(t,new pi({color:pt.path,transparent:!0,opacity:.5})),this.line.frustumCulled=!1}floor;line;ends=new Float32Array(6);place([e,t,n]){this.ends.set([e,t,n,e,t,this.floor]),this.line.geometry.attributes.position.needsUpdate=!0}};function cy(i){let[e,t,n]=i.position,s=i.length/2;return{from:[e,t-s,n],to:[e,t+s,n],radius:Math.max(i.width,i.height)/2}}var Xu=class{group=new At;outline;rotors;constructor(e,t){let{shapes:n}=e.vehicle,s=kf(n,t==="full"?24:9);this.outline=t==="full"?s:kf(n,5);let r=new ct(s,pR(t));r.castShadow=r.receiveShadow=t==="full",r.frustumCulled=!1,this.rotors=new Uh(e,t),this.group.add(r,this.rotors.group)}place(e,t){this.group.position.set(...e),this.group.quaternion.set(t[1],t[2],t[3],t[0])}},ll=class{group=new At;veil;constructor(e,t=pt.path){this.veil=new ln({color:t,transparent:!0,opacity:.35,depthWrite:!1});let n=new ct(e,new ln({colorWrite:!1,transparent:!0})),s=new ct(e,this.veil);n.renderOrder=5,s.renderOrder=6,this.group.add(n,s)}show(e){if(this.group.visible=e!==null,!e)return;let[t,n,s,r]=e.attitude;this.group.position.set(...e.position),this.group.quaternion.set(n,s,r,t).normalize()}place(e,t,n){let s=.3*Math.min(Math.max((n-.02)/.1,0),1);this.group.visible=s>.01,this.veil.opacity=s,this.group.position.set(...e),this.group.rotation.set(0,0,t)}};function pR(i){return i==="light"?new On({vertexColors:!0}):new ba({vertexColors:!0,roughness:.5,metalness:.15})}var Ir=30,mR=15,cl=5,qu=5,gR=.9,vR=.5,xR=.1,hy=.34,kp=24,Yu=class{group=new At;ground=new At;walls;constructor(e,t){this.ground.position.z=e.floor,e.ground&&t==="full"&&this.ground.add(yR()),this.ground.add(_R(t==="full"?Ir:mR)),this.group.add(this.ground),t==="full"&&this.group.add(MR()),this.walls=e.walls.length?new Bp(e.walls,t):null,this.walls&&this.group.add(...this.walls.parts),e.corridor&&this.group.add(bR(e,t))}update(e,t){this.ground.position.x=cl*Math.round(e.x/cl),this.ground.position.y=cl*Math.round(e.y/cl),this.walls?.update(e,t)}},Bp=class{parts;paint;places;constructor(e,t){let n=e.map(d=>new ti(...d.size).rotateZ(d.heading).translate(...d.center)),s=Ao(n.map(d=>new vr(d))),r=Ao(n),{r:o,g:a,b:l}=new qe(pt.wall),c=Array.from({length:kp*e.length},()=>[o,a,l,hy]).flat();this.paint=new Qt(new Float32Array(c),4),r.setAttribute("color",this.paint);let h={vertexColors:!0,transparent:!0,depthWrite:!1},u=t==="light"?new ln(h):new On(h);this.parts=[new ct(r,u),new os(s,new pi({color:pt.frame}))],this.parts[0].renderOrder=2,this.places=e.map(({center:d,size:f,heading:m})=>{let[_,g]=f[0]<f[1]?[1,0]:[0,1],p=new U(_,g,0).applyAxisAngle(new U(0,0,1),m);return{center:new U(...d),across:p,clear:!1}})}update(e,t){this.places.forEach((n,s)=>{let r=a=>n.across.dot(a)-n.across.dot(n.center),o=r(e)*r(t)<0;if(o!==n.clear){n.clear=o;for(let a=kp*s;a<kp*(s+1);a++)this.paint.setW(a,o?xR:hy);this.paint.needsUpdate=!0}})}};function yR(){let i=6*Ir,e=new ct(new xr(i,i),new On({color:pt.floor,depthWrite:!1}));return e.receiveShadow=!0,e.renderOrder=-2,e}function _R(i){let e=[],t=[],{r:n,g:s,b:r}=new qe(pt.grid);for(let a=-Ir;a<=Ir;a++){let l=a%cl===0;for(let c=-Ir;c<Ir;c+=qu){let[h,u]=[c,c+qu].map(d=>{let f=i===Ir?1:1-Math.hypot(a,d)/i;return l?gR:vR*Math.max(f,0)});if(h+u!==0){e.push(c,a,0,c+qu,a,0,a,c,0,a,c+qu,0);for(let d of[h,u,h,u])t.push(n,s,r,d)}}}let o=new zt().setAttribute("position",new Qt(new Float32Array(e),3));return o.setAttribute("color",new Qt(new Float32Array(t),4)),new os(o,new pi({vertexColors:!0,transparent:!0,depthWrite:!1}))}function bR(i,e){let{centreline:t,width:n}=i.corridor,s=[],r=[];t.forEach(([c,h],u)=>{let[d,f]=SR(t,u,n/2);s.push(c-d,h-f,0,c+d,h+f,0),u&&r.push(...[0,2,1,1,2,3].map(m=>2*(u-1)+m))});let o=new zt;o.setAttribute("position",new Qt(new Float32Array(s),3)),o.setIndex(r),o.computeVertexNormals();let a={color:pt.lane,depthWrite:!1},l=new ct(o,e==="light"?new ln(a):new On(a));return l.receiveShadow=e==="full",l.position.z=i.floor,l.renderOrder=-1,l}function SR(i,e,t){let n=l=>{let[c,h]=[i[Math.max(l,0)],i[Math.min(l+1,i.length-1)]];return Math.atan2(h[1]-c[1],h[0]-c[0])},[s,r]=[n(e>0?e-1:0),n(Math.min(e,i.length-2))],o=Math.atan2(Math.sin(r-s),Math.cos(r-s))/2,a=t/Math.max(Math.cos(o),.3);return[-Math.sin(s+o)*a,Math.cos(s+o)*a]}function MR(){let i=new Jn(300,24,16).rotateX(Math.PI/2),e=i.getAttribute("position"),[t,n]=[new qe(pt.haze),new qe(pt.zenith)],s=Array.from({length:e.count},(a,l)=>{let c=Math.min(Math.max(e.getZ(l)/300,0),1);return t.clone().lerp(n,Math.sqrt(c)).toArray()}).flat();i.setAttribute("color",new Qt(new Float32Array(s),3));let r=new ln({vertexColors:!0,side:Un,fog:!1,depthWrite:!1}),o=new ct(i,r);return o.renderOrder=-3,o}var hl=class{constructor(e,t,n,s=new Hu){this.scene=e;this.stage=t;this.labels=n;this.trails=s;this.vehicle=new Xu(e,t.graphics),this.world=new Yu(e,t.graphics),this.ghost=new ll(this.vehicle.outline),this.rival=new ll(this.vehicle.outline,pt.contact),this.rival.show(null),this.shadow=new Vu(this.vehicle.outline,e.floor),this.plumb=new Wu(e.floor),this.threshold=e.threshold,this.stiffness=e.spring.stiffness,this.reach=wR(e),this.person=new zu(e.floor,this.reach,t.graphics),this.trails.begin(),this.shadow.mesh.visible=e.ground&&t.graphics==="light";let r=[this.push.group,this.wind.group,this.hold.group,this.end.group,this.contact.group],o=[this.trails.group,this.plumb.line],a=[this.vehicle.group,this.ghost.group,this.rival.group,this.person.mesh];this.root.add(this.world.group,this.shadow.mesh,...a,...r,...o),t.scene.add(this.root)}scene;stage;labels;trails;vehicle;center=new U;reach;threshold;stiffness;root=new At;world;ghost;rival;shadow;push=new Eu;wind=new ir(pt.wind,.014,.14,.1);hold=new Bu;end=new Eo(pt.push);contact=new Oh;person;plumb;time=NaN;remove(){this.stage.scene.remove(this.root),this.trails.group.removeFromParent(),this.root.traverse(e=>{if(!(e instanceof ct||e instanceof rs))return;let t=e;t.geometry.dispose();for(let n of[t.material].flat())n.dispose()});for(let e of Object.values(this.labels))e.hide()}update(e,t,n,s){let r=e.scalar("time"),o=Math.min(Math.max(r-this.time,0),.1)||0;(r<this.time-.001||r>this.time+1)&&this.trails.begin();let a=e.vector("position");this.vehicle.place(a,e.attitude),this.vehicle.group.updateMatrixWorld(),this.center.set(...a),this.vehicle.rotors.update(e.list("thrusts"),o),this.vehicle.rotors.arrows.visible=n.thrust,this.trails.stay=n.trails,r!==this.time&&this.trails.add(a),this.trails.group.visible=this.plumb.line.visible=n.trail,this.person.mesh.visible=n.person,n.person&&this.person.accompany(this.center),this.plumb.place(a),this.shadow.place(this.vehicle.group),this.showReference(e,a,n.ghost),this.showForces(e,n),this.showHand(e,t,n.zone),this.showContact(e),s?this.labels.refusal.show(s.text,this.inWorld(s.point),this.stage.camera):this.labels.refusal.hide(),this.time=r}draw(){this.world.update(this.center,this.stage.camera.position),this.stage.draw(this.center,this.reach)}showEnding(e,t){t?(this.end.show(new U(...t)),this.labels.ending.show(e,this.end.group.position,this.stage.camera)):(this.end.hide(),this.labels.ending.hide())}inWorld(e){return this.vehicle.group.localToWorld(new U(...e))}showReference(e,t,n){let s=e.vector("reference"),r=Math.hypot(...s.map((o,a)=>o-t[a]));n?this.ghost.place(s,e.scalar("reference_yaw"),r):this.ghost.group.visible=!1}showForces(e,t){let[n,s]=[e.vector("push"),e.vector("wind")],r=new U(...e.vector("push_moment")).applyQuaternion(this.vehicle.group.quaternion);this.push.group.visible=t.push,this.push.show(this.inWorld(e.vector("push_point")),n,r,t.zone?this.threshold:null);let o=this.center.clone().add(new U(0,0,.55+.1*this.reach)),a=new U(...s).multiplyScalar(.07);this.wind.show(o.sub(a),t.wind?s:[0,0,0]);let l=this.stage.camera,{arrow:c,moment:h}=this.push;t.push&&c.visible?this.labels.push.show(Yx(n,this.threshold),c.tip,l):this.labels.push.hide(),t.push&&h.group.visible?this.labels.moment.show(`${r.length().toFixed(1)} N m`,h.tip,l):this.labels.moment.hide(),this.wind.visible?this.labels.wind.show(`wind ${Zt(s).toFixed(1)} m/s`,this.wind.tip,l):this.labels.wind.hide()}showContact(e){let t=this.contact.update(e,this.scene.phases);t?this.labels.contact.show(t,this.contact.place,this.stage.camera):this.labels.contact.hide()}showHand(e,t,n){let s=n?this.zone():null;if(t.kind==="pull")this.hold.show(this.inWorld(t.point),new U(...t.target),s);else if(e.scalar("held")>0){let r=new U(...e.vector("hand_target"));this.hold.show(this.inWorld(e.vector("hand_point")),r,s)}else t.kind==="offer"?this.hold.offer(this.inWorld(t.point)):this.hold.hide()}zone(){return this.stiffness<=0?null:new U(...this.threshold).divideScalar(this.stiffness).clampScalar(.003,2)}};function wR(i){let{quadrotors:e,payload:t}=i.vehicle,n=e.flatMap(s=>s.rotors.map(r=>Zt(r.position)+r.radius));return Math.max(t.length/2,...n)}var TR=["pointerdown","pointermove","wheel","keydown","resize","hashchange"];var $u=class{constructor(e){this.tick=e}tick;timer=0;touched=0;start(){requestAnimationFrame(this.tick);for(let e of TR)window.addEventListener(e,()=>{this.touched=performance.now(),this.wake()})}next(e){e?this.timer=window.setTimeout(this.wake,500):requestAnimationFrame(this.tick)}look(e,t,n){this.timer&&!this.suits(e,t,n)&&this.wake()}suits(e,t,n){return!e||performance.now()-this.touched<2e3?!1:t.scalar("time")===e.scalar("time")||n&&ER(t,e)}wake=()=>{this.timer&&(window.clearTimeout(this.timer),this.timer=0,requestAnimationFrame(this.tick))}};function ER(i,e){let t=o=>{let a=e.vector(o);return Math.hypot(...i.vector(o).map((l,c)=>l-a[c]))},n=Math.hypot(...i.attitude.map((o,a)=>o-e.attitude[a])),s=["phase","alarm","contact_part"].every(o=>i.scalar(o)===e.scalar(o));return i.scalar("held")===0&&Math.hypot(...i.vector("push"))===0&&!i.ghost&&s&&t("position")+t("reference")+n<.004}var AR=.75,Zu=class{constructor(e,t){this.surface=e;this.graphics=t;this.camera.up.set(0,0,1),this.scene.fog=this.fog,this.scene.add(this.sky,this.sun,this.sun.target),this.sun.shadow.mapSize.set(2048,2048),this.sun.shadow.bias=-4e-4,this.sun.shadow.normalBias=.01,this.sun.shadow.radius=3,this.build(t),new ResizeObserver(()=>this.resize()).observe(e)}surface;graphics;scene=new ua;camera=new Zn(42,1,.05,700);canvas;renderer;sun=new Aa("#fffaf3");sky=new wa("#e8eff8","#9a9894");fog=new ha(pt.haze,20,60);build(e){this.graphics=e;let t=e==="full";yt.enabled=t,[this.sun.intensity,this.sky.intensity]=t?[2.3,1.5]:[1.7,2.6],this.recolor();let n=CR(t);n.outputColorSpace=t?$n:mr,n.shadowMap.enabled=this.sun.castShadow=t,n.shadowMap.type=yr,this.renderer!==void 0&&(this.renderer.dispose(),this.renderer.forceContextLoss(),this.canvas.remove(),this.sun.shadow.dispose(),this.sun.shadow.map=null),this.renderer=n,this.canvas=n.domElement,this.surface.prepend(this.canvas),this.resize()}recolor(){let e=this.graphics==="full"?pt.haze:pt.pale;this.scene.background=new qe(e),this.fog.color.set(e)}draw(e,t){this.renderer.getPixelRatio()!==this.ratio&&this.resize();let n=this.camera.position.distanceTo(e);this.fog.near=n+8,this.fog.far=1.5*n+36,this.light(e,1.3*t+1),this.renderer.render(this.scene,this.camera)}light(e,t){this.sun.target.position.copy(e),this.sun.position.copy(e).addScaledVector(Vo,12);let n=this.sun.shadow.camera;n.right!==t&&(Object.assign(n,{left:-t,right:t,bottom:-t,top:t,near:1,far:40}),n.updateProjectionMatrix())}get ratio(){return this.graphics==="light"?AR:Math.min(window.devicePixelRatio,2)}resize(){let[e,t]=[this.surface.clientWidth||1,this.surface.clientHeight||1];this.camera.aspect=e/t,this.camera.updateProjectionMatrix(),this.renderer.setPixelRatio(this.ratio),this.renderer.setSize(e,t),this.renderer.render(this.scene,this.camera)}};function CR(i){let e=document.createElement("canvas"),n=e.getContext("webgl2",{alpha:!1,antialias:i,stencil:!1,powerPreference:"high-performance"});return new dh({canvas:e,antialias:i,...n&&{context:n}})}var Ku=class{sent=[];delays=[];note(e,t,n){this.sent.push({seq:e,at:t<=n&&n-t<2e3?t:n})}drawn(e,t){let n=this.sent.find(s=>s.seq===e);n&&this.delays.push(t-n.at),this.sent=this.sent.filter(s=>s.seq>e&&t-s.at<2e3),this.delays.length>60&&(this.delays=this.delays.slice(-60))}get median(){if(!this.delays.length)return null;let e=[...this.delays].sort((t,n)=>t-n);return e[e.length>>1]}};var RR=100,ul=class{constructor(e,t,n=[]){this.source=e;this.replay=t;this.extra=n;let s=Ke("surface");this.stage=new Zu(s,Op());let r=this.stage.camera,o=(a,l)=>this.send(a,l);this.grab=new vh({camera:r,surface:s,send:o,options:this.hand,frame:()=>this.current,stiffness:()=>this.picture?.stiffness??0,axis:()=>this.picture&&!this.replay?cy(this.picture.scene.vehicle.payload):null}),this.camera=new Uu(r,s),this.force=new gh(r,this.hand,o,t===null),this.compare=e.compare?.bind(e),this.shell=new Nu(this)}source;replay;extra;hand={at:"point",plane:"facing",kind:"push",frequency:4,force:3,directions:"view"};shown=Kx();latency=new Ku;frameRate=new ku;camera;compare;current=null;graphicsChoice="auto";stage;themes=new Du(e=>this.recolor(e));grab;force;shell;remarks=new xh;rest=new $u(e=>this.tick(e));labels=sy(Ke("labels"));picture=null;last=0;drawn=null;drawnAt=0;eye=new dt;end=null;seat=-1;start(){this.source.start(this),this.rest.start()}explain(e){this.shell.explain(e)}retry(){this.source.retry?.()}send(e,t){let n=this.source.send(e);return n!==null&&t!==void 0&&this.latency.note(n,t,performance.now()),n}get companions(){return this.source.companions}get canvas(){return this.stage.canvas}get graphics(){return this.stage.graphics}look(e){if(!this.picture)return;let{center:t,reach:n,scene:s}=this.picture;if(e!=="board"){this.camera.look(e,t,n,s.corridor!==null);return}this.seat=(this.seat+1)%s.vehicle.quadrotors.length,this.camera.board(s.vehicle.quadrotors[this.seat].position)}setGraphics(e){this.graphicsChoice=e,this.rebuild(e==="auto"?Op():e)}get theme(){return this.themes.choice}setTheme(e){this.themes.choose(e)}scene(e){let t=this.picture===null;this.grab.release(),this.current=null,this.picture?.remove();let n=this.picture?.scene.mission===e.mission?this.picture.trails:void 0;this.picture=new hl(e,this.stage,this.labels,n),this.shell.scene(e),t&&(this.picture.center.set(0,0,1),this.look("behind"))}frame(e){e.drawable&&(this.current||this.picture?.center.set(...e.vector("position")),this.current=e,this.shell.frame(e),this.rest.look(this.drawn,e,this.mayRest))}status(e){e.holder!=="you"&&this.grab.cancel(e.last_grab),this.remarks.status(e),this.end=e.ending,this.shell.status(e)}changed(e,t,n){this.picture&&e===To&&(this.picture.threshold=yh(t)),this.picture&&e===x0&&(this.picture.stiffness=Number(t)),this.shell.changed(e,t,n)}refused(e,t){if(["grab","force"].includes(e)){this.remarks.refuse(t,this.grab.hand),this.grab.release(),e==="force"&&this.force.refuse();return}this.shell.refused(e,t)}done(e,t){this.shell.done(e,t)}disconnected(e){this.grab.cancel(),this.shell.disconnected(e)}connected(){this.shell.connected()}get mayRest(){return this.graphics==="light"&&!this.replay}tick(e){let{current:t,drawn:n}=this,r=!(!t||this.shell.recording||this.moved())&&this.rest.suits(n,t,this.mayRest);this.rest.next(r);let o=Math.min((e-this.last)/1e3,.1);this.last=e,this.source.tick?.(e),this.current&&this.picture&&this.draw(this.current,this.picture,e,o),this.shell.tick(e),this.frameRate.tick(e,this.drawnAt===e,r)&&this.graphicsChoice==="auto"&&!this.shell.recording&&this.rebuild("light")}draw(e,t,n,s){t.update(e,this.grab.hand,this.shown,this.remarks.now(e)),t.showEnding(this.end?`${this.end.outcome} here, ${this.end.time.toFixed(2)} s`:"",this.end?.place??null);let r=e.ghost?.drawable?e.ghost:null;t.rival.show(r?r.pose:this.shell.challenge.rival),this.camera.update(t.vehicle.group,this.grab.pulling,s),this.grab.flush(),this.force.flush(this.grab.pulling),!(e===this.drawn&&!this.moved()&&n-this.drawnAt<=RR)&&(t.draw(),this.drawn||performance.mark("first picture"),[this.drawn,this.drawnAt]=[e,n],this.eye.copy(this.stage.camera.matrixWorld),this.latency.drawn(e.scalar("seq"),performance.now()))}moved(){return this.stage.camera.updateMatrixWorld(),!this.eye.equals(this.stage.camera.matrixWorld)}rebuild(e){e!==this.stage.graphics&&(this.shell.endVideo(),this.stage.build(e),this.repaint())}recolor(e){D0(e),f0(),this.stage?.recolor(),this.repaint()}repaint(){if(!this.picture)return;let{scene:e,threshold:t,stiffness:n,trails:s}=this.picture;this.picture.remove(),this.picture=new hl(e,this.stage,this.labels,s),Object.assign(this.picture,{threshold:t,stiffness:n}),this.drawn=null}};var or=class{size;places=new Map;constructor(e){let t=0;for(let[n,s]of e)this.places.set(n,{start:t,length:s}),t+=s;this.size=t}has(e){return this.places.has(e)}place(e){return this.places.get(e)??{start:0,length:0}}decode(e){return[4,8].includes(e.byteLength/this.size)?new ar(this,zp(e)):null}smooth(){return[...this.places.keys()].filter(e=>!v0.includes(e))}},ar=class i{constructor(e,t){this.layout=e;this.values=t}layout;values;get drawable(){return[...this.vector("position"),...this.attitude].every(Number.isFinite)&&Math.hypot(...this.attitude)>.5}scalar(e){let{start:t,length:n}=this.layout.place(e);return n?this.values[t]:0}vector(e){let{start:t,length:n}=this.layout.place(e),s=this.values;return n===3?[s[t],s[t+1],s[t+2]]:[0,0,0]}list(e){let{start:t,length:n}=this.layout.place(e);return this.values.subarray(t,t+n)}get ghost(){let{size:e}=this.layout;return this.values.length===2*e?new i(this.layout,this.values.subarray(e)):null}get pose(){return{position:this.vector("position"),attitude:this.attitude}}get attitude(){let{start:e,length:t}=this.layout.place("attitude"),n=this.values;return t===4?[n[e],n[e+1],n[e+2],n[e+3]]:[1,0,0,0]}};function zp(i){if(PR)return new Float32Array(i);let e=new DataView(i);return Float32Array.from({length:i.byteLength/4},(t,n)=>e.getFloat32(4*n,!0))}var PR=new Uint8Array(new Uint32Array([1]).buffer)[0]===1;function uy(i,e,t){let n=Float32Array.from(i.values);for(let s of i.layout.smooth()){let{start:r,length:o}=i.layout.place(s),a=s==="attitude"&&LR(i,e,r)?-1:1;for(let l=r;l<r+o;l++)n[l]=(1-t)*i.values[l]+t*a*e.values[l];s==="attitude"&&IR(n,r)}return new ar(i.layout,n)}function LR(i,e,t){let n=0;for(let s=t;s<t+4;s++)n+=i.values[s]*e.values[s];return n<0}function IR(i,e){let t=Math.hypot(...i.subarray(e,e+4))||1;for(let n=e;n<e+4;n++)i[n]/=t}function dy(i){let e=[...new URLSearchParams(i.replace(/^#/,""))],t=e.filter(([n])=>n!=="mission").map(([n,s])=>[n,DR(s)]);return{mission:e.find(([n])=>n==="mission")?.[1]??null,settings:t}}function fy(i,e){let n=e.filter(({value:s,initial:r})=>!vi(s,r??s)).map(({key:s,value:r})=>`${s}=${encodeURIComponent(NR(r)).replaceAll("%2C",",")}`);return`#${[`mission=${encodeURIComponent(i)}`,...n].join("&")}`}var NR=i=>[i].flat().join(",");function DR(i){let e=i.trim().replace(/^\[(.*)\]$/,"$1"),t=e.split(",").map(n=>n.trim()===""?Number.NaN:Number(n));return t.every(Number.isFinite)?t.length===1&&e===i.trim()?t[0]:t:i}var Ju=class{constructor(e,t,n){this.index=e;this.newWorker=t;this.begin=n}index;newWorker;begin;worker=null;listener=null;layout=null;seq=0;parameters=[];mission="";opened=()=>{};get link(){return fy(this.mission,this.parameters)}get onlyServer(){return this.index.only_server}get missions(){return this.index.missions}get companions(){return this.missions.filter(({name:e})=>e!==this.mission)}start(e){this.listener=e,e.connected(),this.restart()}restart(){let{mission:e,settings:t}=this.begin(),n=this.entry(e??"")??this.missions[0];this.open(n.name,t),e!==null&&n.name!==e&&this.refuseMission(e)}open(e,t){this.worker?.terminate(),[this.layout,this.mission]=[null,e];let n=this.newWorker();n.onmessage=({data:s})=>{n===this.worker&&this.receive(s)},this.worker=n,this.sendFlight("open",n,e,t)}compare(e,t=""){e==="fly"?this.sendFlight("along",this.worker,t,[]):this.post(this.worker,{type:"compare",what:e})}send(e){return e.type==="fly"&&this.entry(e.mission)&&this.open(e.mission,[]),this.layout?(this.seq+=1,this.post(this.worker,{...e,seq:this.seq}),this.seq):null}entry(e){return this.missions.find(({name:t})=>t===e)}async sendFlight(e,t,n,s){let r={...this.index,missions:[]},o=this.entry(n),a=o.file===void 0?null:await FR(o.file);t===this.worker&&this.post(t,{type:e,index:r,entry:o,settings:s,file:a})}post(e,t){e.postMessage(t)}receive(e){let t=this.listener;switch(e.type){case"frame":this.layout&&t.frame(new ar(this.layout,e.values));break;case"scene":this.scene(e);break;case"status":e.holder==="you"&&this.send({type:"ping",t:performance.now()}),t.status(e);break;case"changed":this.parameters=_h(this.parameters,e.key,e.value),t.changed(e.key,e.value,e.duration);break;case"refused":t.refused(e.what,e.reason);break;case"saved":OR(e.name,e.bytes),t.done("save",e.name);break;case"done":case"pong":}}scene(e){this.layout=new or(e.fields),[this.mission,this.parameters]=[e.mission,e.parameters],this.opened(this.mission),this.listener.scene(e)}refuseMission(e){let t=this.missions.map(({name:n})=>n).join(", ");this.listener.refused("link",`mission = ${JSON.stringify(e)}: must be one of ${t}`)}};async function FR(i){try{let e=await fetch(i);return e.ok?await e.arrayBuffer():new ArrayBuffer(0)}catch{return new ArrayBuffer(0)}}function OR(i,e){let t=document.createElement("a");t.href=URL.createObjectURL(new Blob([e],{type:"application/zip"})),t.download=i,t.click(),setTimeout(()=>URL.revokeObjectURL(t.href),1e4)}var py=1;function my(){let i=document.getElementById("flights")?.textContent;return i?JSON.parse(i):null}function gy(i){return i.format!==py?i.other_version:"WebAssembly"in globalThis&&"DecompressionStream"in globalThis?"":i.no_module}function vy(){let i=document.getElementById("worker")?.textContent;if(!i)return new Worker("worker.js");let e=URL.createObjectURL(new Blob([i],{type:"text/javascript"})),t=new Worker(e);return URL.revokeObjectURL(e),t}var UR=2e3;function xy(i,e){let t=X("input",{type:"text",readonly:!0,id:"link","aria-label":"Link to this flight"}),n=X("button",{type:"button",id:"copy-link"},"Copy link");n.addEventListener("click",()=>{t.value=e(),t.select(),kR(t).then(l=>{n.textContent=l?"Copied":"Selected",window.setTimeout(()=>n.textContent="Copy link",UR)})});let s=X("div",{class:"link"},t,n),r=X("ul",{},...i.onlyServer.map(l=>X("li",{},l))),o=X("p",{class:"note"},"This page flies by itself. With tandemlift installed, ");o.append(X("code",{},"tandemlift live")," also has:");let a=X("summary",{},"this page");return X("details",{"data-name":"this page",class:"own-flight"},a,s,o,r)}async function kR(i){try{return await navigator.clipboard.writeText(i.value),!0}catch{return!1}}var Vp=500,BR=5e3,ju=class{constructor(e){this.address=e}address;socket=null;listener=null;layout=null;seq=0;wait=Vp;timer=0;start(e){this.listener=e,this.open()}send(e){return this.socket?.readyState!==WebSocket.OPEN?null:(this.seq+=1,this.socket.send(JSON.stringify({...e,seq:this.seq})),this.seq)}compare(e){e!=="fly"&&this.send({type:"compare",what:e})}retry(){window.clearTimeout(this.timer),this.wait=Vp,this.socket||this.open()}open(){let e=new WebSocket(this.address);e.binaryType="arraybuffer",e.onmessage=({data:t})=>this.receive(t),e.onclose=()=>this.closed(),this.socket=e}closed(){this.socket=null,this.listener?.disconnected(performance.now()+this.wait),this.timer=window.setTimeout(()=>this.open(),this.wait),this.wait=Math.min(2*this.wait,BR)}receive(e){if(typeof e=="string"){this.handle(JSON.parse(e));return}let t=this.layout?.decode(e);t&&this.listener?.frame(t)}handle(e){let t=this.listener;switch(e.type){case"scene":this.layout=new or(e.fields),this.wait=Vp,t.connected(),t.scene(e);break;case"status":e.holder==="you"&&this.send({type:"ping",t:performance.now()}),t.status(e);break;case"changed":t.changed(e.key,e.value,e.duration);break;case"refused":t.refused(e.what,e.reason);break;case"done":t.done(e.what,e.detail);break;case"pong":}}};function yy(i){return`${i.protocol==="https:"?"wss:":"ws:"}//${i.host}/ws${i.search}`}var zR={type:"status",enabled:!0,behind_ms:0,recorded_s:0,failed_rotors:[],tare_left_s:0,refusals:{lift:"",land:"",push:""},viewers:1,holder:"none",last_grab:0},Gp=class{constructor(e,t){this.scene=e;this.layout=new or(e.fields),this.values=t,this.timeAt=this.layout.place("time").start,this.count=Math.floor(t.length/this.layout.size),this.scene.replay??={start:this.timeOf(0),end:this.timeOf(this.count-1),speed:1,ending:null},this.time=this.scene.replay.start,this.speed=this.scene.replay.speed}scene;listener=null;layout;values;timeAt;count;time;paused=!1;speed;last=0;start(e){this.listener=e,e.connected(),e.scene(this.scene),this.show()}send(){return null}get playing(){return!this.paused}play(e){let{start:t,end:n}=this.scene.replay;this.paused=!e,e&&this.time>=n&&(this.time=t),this.show()}seek(e){let{start:t,end:n}=this.scene.replay;this.time=Math.min(Math.max(e,t),n),this.show()}setSpeed(e){this.speed=e}tick(e){let t=this.last?Math.min((e-this.last)/1e3,.25):0;this.last=e,!this.paused&&(this.time+=t*this.speed,this.time>=this.scene.replay.end&&(this.time=this.scene.replay.end,this.paused=!0),this.show())}frames(){return Array.from({length:this.count},(e,t)=>this.frameAt(t))}show(){let e=Math.min(this.index(this.time),this.count-2),[t,n]=[this.frameAt(Math.max(e,0)),this.frameAt(Math.min(e+1,this.count-1))],s=n.scalar("time")-t.scalar("time"),r=s>0?Math.min(Math.max((this.time-t.scalar("time"))/s,0),1):0,o=uy(t,n,r);this.listener?.status(this.status(o)),this.listener?.frame(o)}status(e){let t=this.scene.phases[e.scalar("phase")]??"idle",n=this.scene.alarms[e.scalar("alarm")]??"",{end:s,ending:r}=this.scene.replay,o=this.time>=s?r:null,a={phase:o?.outcome??t,alarm:n,ending:o};return{...zR,...a,paused:this.paused,speed:this.speed,factor:this.speed}}timeOf(e){return this.values[e*this.layout.size+this.timeAt]}frameAt(e){return new ar(this.layout,this.values.subarray(e*this.layout.size,(e+1)*this.layout.size))}index(e){let[t,n]=[0,this.count];for(;n-t>1;){let s=t+n>>1;this.timeOf(s)<=e?t=s:n=s}return t}};function _y(){let i=document.getElementById("flight")?.textContent;if(!i)return null;let{scene:e,frames:t}=JSON.parse(i);return new Gp(e,zp(VR(t)))}function VR(i){let e=atob(i);return Uint8Array.from(e,t=>t.charCodeAt(0)).buffer}function GR(i){let e=()=>dy(window.location.hash),t=new Ju(i,vy,e),n=()=>window.location.href.replace(/#.*/,"")+t.link,s=new zo(t.missions,r=>{window.history.replaceState(null,"",`#mission=${r}`),t.open(r,[])});t.opened=r=>s.show(r),window.addEventListener("hashchange",()=>t.restart()),new ul(t,null,[xy(t,n)]).start()}function HR(i){let e=_y(),t=new ul(e??new ju(yy(window.location)),e);t.start(),window.addEventListener("message",({source:n,data:s})=>{n===window.parent&&typeof s.seek=="number"&&e?.seek(s.seek)}),i&&t.explain(i)}function WR(i){Ke("mode").textContent="no picture",Ke("hint").hidden=!1,Ke("hint").textContent="This browser shows no 3D graphics (WebGL), which the page needs.",console.error(i)}try{let i=my(),e=i?gy(i):"";i&&!e?GR(i):HR(e)}catch(i){WR(i)}
/*!
three

The MIT License

Copyright © 2010-2026 three.js authors

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE.

uplot

The MIT License (MIT)

Copyright (c) 2022 Leon Sorokin

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE.
*/
